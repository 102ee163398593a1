// YUV becomes RGB by the matrix that is named, as standards have it, or it is refused.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "capture/error.hpp"
#include "support/chromaticity.hpp"
#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

std::string coloured_picture(const std::string& size) {
  return "-f lavfi -i testsrc2=s=" + size + ":d=0.08:r=25 -c:v ffv1 -pix_fmt yuv420p ";
}

std::string matrix_of(const Clip& clip) { return facts_of(clip).at(Setting::matrix).line(); }

// Wrong colours do not come out with a note: a matrix that is none of those known here has to be stated.
TEST(MatrixOfYuv, OfAMatrixThatIsNotKnownIsRefused) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const char* named :
       {"ictcp", "smpte2085", "chroma-derived-c", "bt2020c", "chroma-derived-nc -color_primaries film"}) {
    test::make(scratch, coloured_picture("64x48") + "-colorspace " + named + " clip.mkv");
    const auto error = error_of<InputError>([&] { return open_test_clip(scratch / "clip.mkv"); });
    ASSERT_TRUE(error) << named << " was read";
    const std::string message = error->what(), words = named;
    expect_says(message,
                "clip.mkv names a matrix by which no RGB is made here, " + words.substr(0, words.find(' ')) + ":");
    EXPECT_EQ(error->settings(), std::vector{Setting::matrix});
    EXPECT_EQ(matrix_of(*open_test_clip(scratch / "clip.mkv", {.matrix = YuvMatrix::bt709})),
              "matrix bt709, as stated");
  }
  // What has no YUV needs none.
  test::make(scratch,
             "-f lavfi -i testsrc2=s=64x48:d=0.08:r=25 -c:v ffv1 -pix_fmt gray -colorspace ictcp grey.mkv");
  EXPECT_EQ(read_all(*open_test_clip(scratch / "grey.mkv")).size(), 2u);
  // The box of its pixels' shape becomes one of Dolby Vision.
  test::make(scratch, "-f lavfi -i testsrc2=s=64x48:d=0.08:r=25 -c:v mpeg4 dolby.mp4");
  std::string bytes = read_file(scratch / "dolby.mp4");
  bytes.replace(bytes.find("pasp"), 12, "dvcC\1\0\x0A\x0D\0\0\0\0", 12);
  expect_clip_refused(scratch.write("dolby.mp4", bytes), {},
                      "IPT of Dolby Vision's profile 5: its colours would be wrong. Convert it: ffmpeg -i CLIP "
                      "-vf libplacebo");
}

// The advised commands make light that is right to a hundredth; where none does, none is advised.
TEST(MatrixOfYuv, OfAMatrixThatIsNotKnownIsConvertedByTheAdvisedCommand) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const std::array<double, 3> light{0.7, 0.2, 0.4};
  const auto bt709 = [](double value) { return 1.09929682680944 * std::pow(value, 0.45) - 0.09929682680944; };
  const double luma = bt709(0.2627 * light[0] + 0.6780 * light[1] + 0.0593 * light[2]);
  const double from_blue = bt709(light[2]) - luma, from_red = bt709(light[0]) - luma;
  const std::array constant{luma, from_blue / (from_blue < 0 ? 1.9404 : 1.5816),
                            from_red / (from_red < 0 ? 1.7184 : 0.9936)};
  // BT.2100, table 7.
  std::array<double, 3> lms{};
  const std::array<std::array<double, 3>, 3> weights{{{1688, 2146, 262}, {683, 2951, 462}, {99, 309, 3688}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) lms[i] += weights[i][k] * light[k] / 4096;
    lms[i] = Transfer::pq().fraction_of(lms[i]);
  }
  const std::array ictcp{(lms[0] + lms[1]) / 2, (6610 * lms[0] - 13'613 * lms[1] + 7003 * lms[2]) / 4096,
                         (17'933 * lms[0] - 17'390 * lms[1] - 543 * lms[2]) / 4096};
  const auto message_of = [&](const std::array<double, 3>& yuv, const std::string& tags) {
    const std::array code{static_cast<int>(std::lround(4 * (16 + 219 * yuv[0]))),
                          static_cast<int>(std::lround(4 * (128 + 224 * yuv[1]))),
                          static_cast<int>(std::lround(4 * (128 + 224 * yuv[2])))};
    scratch.write("raw", planes_of(std::vector(1024, code)));
    test::make(scratch, from_raw({32, 32, 1}, "yuv444p10le") +
                            "-c:v ffv1 -color_range tv -color_primaries bt2020 -colorspace " + tags + " clip.mkv");
    return std::string(error_of<InputError>([&] { return open_test_clip(scratch / "clip.mkv"); })->what());
  };
  for (const auto& [yuv, tags] : {std::pair(constant, "bt2020c -color_trc bt2020-10"),
                                  {constant, "chroma-derived-c -color_trc bt709"},
                                  {ictcp, "ictcp -color_trc smpte2084"}}) {
    const std::string text = message_of(yuv, tags);
    const std::size_t begin = text.find("-i CLIP"), end = text.find(", or state the matrix");
    ASSERT_LT(begin, end) << text;
    test::make(scratch, "-i clip.mkv" + text.substr(begin + 7, end - begin - 7));
    const auto clip = open_test_clip(scratch / "converted.mkv");
    const auto raster = read_all(*clip).at(0);
    EXPECT_EQ(clip->info().format.primaries, Primaries::bt2020) << tags;
    for (std::size_t i = 0; i < 3; ++i) {
      const CaptureFormat& format = clip->info().format;
      EXPECT_NEAR(format.transfer.light_of(code_at(format, raster, i) / 65'535.0), light[i], 0.01) << tags << i;
    }
  }
  for (const char* tags : {"smpte2085 -color_trc smpte2084", "ictcp -color_trc arib-std-b67", "bt2020c"})
    expect_says(message_of(constant, tags), "No command is known that converts it truly");
}

// Luma that weighs channels as white light is made of the file's primaries.
TEST(MatrixOfYuv, OfAMatrixFromPrimariesFollowsThese) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const auto& [primaries, matrix] :
       {std::pair{"bt709", "matrix bt709"}, {"bt2020", "matrix bt2020"}, {"smpte432", "matrix p3"}}) {
    test::make(scratch, coloured_picture("64x48") + "-colorspace chroma-derived-nc -color_primaries " +
                            primaries + " clip.mkv");
    EXPECT_EQ(matrix_of(*open_test_clip(scratch / "clip.mkv")), std::string(matrix) + ", from the file");
  }
  // P3's weights are those of no standard: luma is Y of XYZ.
  const auto weights = to_xyz({{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}})[1];
  const std::vector<std::array<int, 3>> yuv{
      {500, 600, 470}, {300, 480, 560}, {700, 512, 512}, {640, 400, 620}};
  scratch.write("raw", planes_of(yuv));
  test::make(scratch,
             "-f rawvideo -s 4x1 -pix_fmt yuv444p10le -r 25 -i raw -c:v ffv1 -colorspace chroma-derived-nc "
             "-color_primaries smpte432 -color_range tv clip.mkv");
  const auto clip = open_test_clip(scratch / "clip.mkv");
  const auto raster = read_all(*clip).at(0);
  for (std::size_t i = 0; i < yuv.size(); ++i) {
    const double y = (yuv[i][0] - 64) / 876.0, u = (yuv[i][1] - 512) / 896.0, v = (yuv[i][2] - 512) / 896.0;
    const double red = y + 2 * (1 - weights[0]) * v, blue = y + 2 * (1 - weights[2]) * u;
    const std::array rgb{red, (y - weights[0] * red - weights[2] * blue) / weights[1], blue};
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(code_at(clip->info().format, raster, i * 3 + channel), 65'535 * rgb[channel], 0.501)
          << i << ", " << channel;
    }
  }
}

// Chroma that rises evenly is right between its samples, too, wherever the file says that these lie: half a pixel
// aside is three codes of 10 bits here.
TEST(MatrixOfYuv, TakesChromaFromWhereItLies) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  constexpr int kSide = 32, kRise = 12, kFirst = 400;
  for (const auto& [named, across, down] : {std::tuple("left", 0.0, 0.5),
                                            {"center", 0.5, 0.5},
                                            {"topleft", 0.0, 0.0},
                                            {"unspecified", 0.0, 0.5}}) {
    for (const bool is_across : {true, false}) {
      std::vector<std::array<int, 3>> luma(kSide * kSide, {500, 0, 0});
      std::string raw = planes_of(luma).substr(0, std::size_t{2} * kSide * kSide);
      for (const int rise : {kRise, 0}) {  // of U, and of V, which is grey
        for (int i = 0; i < kSide * kSide / 4; ++i) {
          const int code = rise == 0 ? 512 : kFirst + rise * (is_across ? i % (kSide / 2) : i / (kSide / 2));
          raw += {static_cast<char>(code & 255), static_cast<char>(code >> 8)};
        }
      }
      scratch.write("raw", raw);
      test::make(scratch,
                 std::string("-f rawvideo -s 32x32 -pix_fmt yuv420p10le -r 25 -i raw -c:v ffv1 -colorspace "
                             "bt709 -color_range tv -chroma_sample_location ") +
                     named + " -y clip.mkv");
      const auto clip = open_test_clip(scratch / "clip.mkv");
      const auto raster = read_all(*clip).at(0);
      for (int at = 6; at < kSide - 6; ++at) {  // away from the borders
        const std::size_t pixel = is_across ? std::size_t{16} * kSide + at : std::size_t(at) * kSide + 16;
        const double u = (kFirst + kRise * (at - (is_across ? across : down)) / 2 - 512) / 896.0;
        const double blue = (500 - 64) / 876.0 + 2 * (1 - 0.0722) * u;
        // The scaler rounds chroma to 16 bits, in which a code of 10 bits is 64; its filter's weights are of 14 bits.
        EXPECT_NEAR(code_at(clip->info().format, raster, pixel * 3 + 2), 65'535 * blue, 16)
            << named << (is_across ? ", column " : ", row ") << at;
      }
    }
  }
}

// What is stated goes before what the file says, and is refused where nothing depends on it.
TEST(MatrixOfYuv, TakesChromaFromWhereItIsStatedToLie) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const auto make_clip = [&](const std::string& pixels, const std::string& named) {
    test::make(scratch, "-f lavfi -i testsrc2=s=32x32:r=25:d=0.04 -vf format=" + pixels +
                            " -c:v ffv1 -chroma_sample_location " + named + " -y clip.mkv");
  };
  const auto raster_of = [&](const ClipOptions& options, const char* fact) {
    const auto clip = open_test_clip(scratch / "clip.mkv", options);
    EXPECT_EQ(facts_of(*clip).at(Setting::chroma_place).line(), fact);
    return read_all(*clip).at(0);
  };
  const ClipOptions stated{.chroma_at = ChromaPlace::center};
  make_clip("yuv420p10", "center");
  const auto centred = raster_of({}, "chroma at center, from the file");
  make_clip("yuv420p10", "unspecified");
  const auto assumed = raster_of({}, "chroma at left, assumed");
  EXPECT_NE(assumed, centred);
  EXPECT_EQ(raster_of(stated, "chroma at center, as stated"), centred);
  make_clip("yuv420p10", "topleft");
  EXPECT_EQ(raster_of(stated, "chroma at center, as stated"), centred);
  for (const auto& [pixels, reason] :
       {std::pair("yuv420p", "the chroma of the sample that it shares"),
        {"yuv444p10", "has chroma of its own: leave"},
        {"gray10", "its pictures are RGB or grey as they are: leave matrix"}}) {
    make_clip(pixels, "unspecified");
    EXPECT_FALSE(facts_of(*open_test_clip(scratch / "clip.mkv")).contains(Setting::chroma_place));
    expect_clip_refused(scratch / "clip.mkv", stated, reason);
  }
}

// Described raw video whose components lie beside each other, and the same values plane by plane.
TEST(PackedVideo, HasTheCodesOfItsPlanes) {
  const Scratch scratch;
  const auto open = [&](const std::string& bytes, const char* pixels) {
    return open_test_clip(scratch.write(pixels, bytes), {.raw = RawVideo{16, 16, pixels}});
  };
  const auto append = [](std::string& to, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> 8 * i & 255);
  };
  Random random(8);
  for (const auto& [packed, planar, bits] :
       {std::tuple("x2rgb10le", "gbrp10le", 10), {"x2bgr10le", "gbrp10le", 10}, {"nv16", "yuv422p", 8},
        {"nv20le", "yuv422p10le", 10}}) {
    const bool is_rgb = *packed == 'x', is_blue_first = packed == std::string("x2bgr10le");
    const std::size_t counts[] = {256, is_rgb ? 256u : 128u, is_rgb ? 256u : 128u};
    std::vector<std::uint32_t> planes[3];  // G, B, R or Y, U, V
    std::string in_planes, together;
    const int bytes = bits > 8 ? 2 : 1;
    for (std::size_t plane = 0; plane < 3; ++plane) {
      for (std::size_t i = 0; i < counts[plane]; ++i) {
        const int white = (1 << bits) - 1;
        planes[plane].push_back(static_cast<std::uint32_t>(i == 0 ? white : random.whole(0, white)));
        append(in_planes, planes[plane].back(), bytes);
      }
    }
    for (std::size_t i = 0; i < 256; ++i) {
      const auto &high = planes[is_blue_first ? 1 : 2], &low = planes[is_blue_first ? 2 : 1];
      if (is_rgb) append(together, high[i] << 20 | planes[0][i] << 10 | low[i], 4);
      if (!is_rgb) append(together, planes[0][i], bytes);
    }
    for (std::size_t i = 0; i < 128 && !is_rgb; ++i) {
      append(together, planes[1][i], bytes);
      append(together, planes[2][i], bytes);
    }
    const auto raster = read_all(*open(together, packed)).at(0);
    EXPECT_TRUE(raster == read_all(*open(in_planes, planar)).at(0)) << packed;
    EXPECT_TRUE(!is_rgb || raster[0] == std::byte{255}) << "white";
  }
  expect_clip_refused(scratch.write("411", std::string(384, 'x')), {.raw = RawVideo{16, 16, "uyyvyy411"}},
                      "those of yuv411p can");
}

// H.273, equations of MatrixCoefficients 8, from their words: of codes whose range is that of luma.
TEST(MatrixOfYuv, OfYCgCoIsThatOfTheStandard) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const int bits : {8, 10}) {
    for (const bool is_full : {false, true}) {
      const int unit = 1 << (bits - 8), half = 128 * unit;
      const int black = is_full ? 0 : 16 * unit, white = is_full ? (1 << bits) - 1 : 235 * unit;
      Random random(7);
      std::vector<std::array<int, 3>> rgb, yuv;
      while (rgb.size() < 4096) {
        std::array<int, 3> codes{};
        for (int& code : codes) code = static_cast<int>(random.whole(black, white));
        const auto [r, g, b] = codes;
        if ((r + b) % 4 != 0 || g % 2 != 0) continue;  // so that nothing is rounded
        rgb.push_back(codes);
        yuv.push_back({g / 2 + (r + b) / 4, g / 2 - (r + b) / 4 + half, (r - b) / 2 + half});
      }
      std::string raw;
      for (std::size_t plane = 0; plane < 3; ++plane) {
        for (const auto& pixel : yuv) {
          raw += static_cast<char>(pixel[plane] & 255);
          if (bits > 8) raw += static_cast<char>(pixel[plane] >> 8);
        }
      }
      scratch.write("raw", raw);
      test::make(scratch, "-f rawvideo -s 64x64 -pix_fmt " +
                              std::string(bits == 8 ? "yuv444p" : "yuv444p10le") +
                              " -r 25 -i raw -c:v ffv1 -colorspace ycgco -color_range " +
                              (is_full ? "pc" : "tv") + " clip.mkv");
      const auto clip = open_test_clip(scratch / "clip.mkv");
      EXPECT_EQ(matrix_of(*clip), "matrix ycgco, from the file");
      const CaptureFormat& format = clip->info().format;
      const auto raster = read_all(*clip).at(0);
      for (std::size_t i = 0; i < rgb.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
          const double exact = format.white_code * double(rgb[i][channel] - black) / (white - black);
          ASSERT_NEAR(code_at(format, raster, i * 3 + channel), exact, bits == 8 ? 0.53 : 0.51)
              << bits << " bits, " << (is_full ? "full" : "limited") << ", pixel " << i << ", " << channel;
        }
      }
    }
  }
}

// Even patches, so that nobody's way of spreading chroma matters.
TEST(MatrixOfYuv, OfEveryMatrixAndRangeIsThatOfZscale) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  if (run_shell("ffmpeg -v error -f lavfi -i color=s=16x16:d=0.04 -vf zscale -f null -", scratch.folder()).status !=
      0) {
    GTEST_SKIP() << "this ffmpeg has no zscale";
  }
  constexpr std::size_t kSide = 320, kPatch = 16;
  struct Kind {
    const char *pixels, *rgb;
    int bits;
  };
  Random random(6);
  for (const Kind& kind : {Kind{"yuv420p", "gbrp", 8}, Kind{"yuv420p10le", "gbrp10le", 10}}) {
    const std::size_t bytes = kind.bits > 8 ? 2 : 1;
    for (const auto& [matrix, zscale] : {std::pair{YuvMatrix::bt601, "170m"},
                                         {YuvMatrix::bt709, "709"},
                                         {YuvMatrix::bt2020, "2020_ncl"},
                                         {YuvMatrix::ycgco, "ycgco"}}) {
      for (const CodeRange range : {CodeRange::limited, CodeRange::full}) {
        std::array<std::vector<int>, 3> patches;
        for (std::size_t i = 0; i < (kSide / kPatch) * (kSide / kPatch); ++i) {
          const int unit = 1 << (kind.bits - 8);
          patches[0].push_back(static_cast<int>(random.whole(16, 235)) * unit);
          for (std::size_t plane : {1, 2})
            patches[plane].push_back(static_cast<int>(random.whole(90, 166)) * unit);
        }
        std::string raw;
        for (std::size_t plane = 0; plane < 3; ++plane) {
          const std::size_t side = plane == 0 ? kSide : kSide / 2, patch = plane == 0 ? kPatch : kPatch / 2;
          for (std::size_t y = 0; y < side; ++y) {
            for (std::size_t x = 0; x < side; ++x) {
              const int code = patches[plane][y / patch * (kSide / kPatch) + x / patch];
              raw += static_cast<char>(code & 255);
              if (bytes == 2) raw += static_cast<char>(code >> 8);
            }
          }
        }
        scratch.write("raw", raw);
        test::make(scratch, "-f rawvideo -s 320x320 -r 25 -pix_fmt " + std::string(kind.pixels) +
                                " -i raw -c:v ffv1 clip.mkv");
        test::make(scratch, "-i clip.mkv -vf zscale=matrixin=" + std::string(zscale) +
                                ":rangein=" + std::string(to_text(range)) +
                                ":matrix=gbr:range=full,format=" + kind.rgb + " -f rawvideo wanted");
        std::ifstream file(scratch / "wanted", std::ios::binary);
        const std::string wanted((std::istreambuf_iterator<char>(file)), {});
        ASSERT_EQ(wanted.size(), kSide * kSide * 3 * bytes);
        const auto clip = open_test_clip(scratch / "clip.mkv", {.matrix = matrix, .range = range});
        const auto raster = read_all(*clip).at(0);
        const double white = clip->info().format.white_code, most = (1 << kind.bits) - 1;
        for (std::size_t y = kPatch / 2; y < kSide; y += kPatch) {
          for (std::size_t x = kPatch / 2; x < kSide; x += kPatch) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
              constexpr std::size_t kPlaneOf[] = {2, 0, 1};  // of green, blue, red
              const std::size_t at = (kPlaneOf[channel] * kSide * kSide + y * kSide + x) * bytes;
              const int expected = static_cast<unsigned char>(wanted[at]) +
                                   (bytes == 2 ? static_cast<unsigned char>(wanted[at + 1]) << 8 : 0);
              const double code = code_at(clip->info().format, raster, (y * kSide + x) * 3 + channel) / white * most;
              ASSERT_LE(std::fabs(code - expected), 2.0)
                  << kind.pixels << ", " << zscale << ", " << to_text(range) << ", channel " << channel;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace nutik::test
