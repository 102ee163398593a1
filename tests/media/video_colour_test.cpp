// What a video's codes are taken for: matrix, range, transfer function, primaries, shape and direction of its pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>

#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::Scratch;

// The text of each fact, with who said it.
std::map<Setting, std::pair<std::string, Origin>> facts_of(const Clip& clip) {
  std::map<Setting, std::pair<std::string, Origin>> facts;
  for (const Fact& fact : clip.info().facts) facts[fact.setting] = {fact.text, fact.origin};
  return facts;
}

std::pair<std::string, Origin> assumed(const char* text) { return {text, Origin::assumed}; }
std::pair<std::string, Origin> from_file(const char* text) { return {text, Origin::file}; }
std::pair<std::string, Origin> stated(const char* text) { return {text, Origin::stated}; }

std::string test_picture(const std::string& size) {
  return "-f lavfi -i testsrc2=s=" + size + ":d=0.08:r=25 -c:v ffv1 -pix_fmt yuv420p ";
}

TEST(VideoColour, OfFilesThatSayNothingDependsOnTheirLines) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, test_picture("64x720") + "high.mkv");
  test::make(scratch, test_picture("64x718") + "low.mkv");
  EXPECT_EQ(facts_of(*test::open_test_clip(scratch / "high.mkv"))[Setting::matrix], assumed("matrix bt709"));
  EXPECT_EQ(facts_of(*test::open_test_clip(scratch / "low.mkv"))[Setting::matrix], assumed("matrix bt601"));
  EXPECT_EQ(facts_of(*test::open_test_clip(scratch / "low.mkv"))[Setting::range], assumed("limited range"));
  EXPECT_EQ(facts_of(*test::open_test_clip(scratch / "low.mkv"))[Setting::transfer],
            assumed("transfer srgb"));
  // It matters: the codes are those of the matrix that was taken.
  ClipOptions other;
  other.matrix = YuvMatrix::bt601;
  const auto usual = test::open_test_clip(scratch / "high.mkv"),
             changed = test::open_test_clip(scratch / "high.mkv", other);
  EXPECT_NE(test::read_all(*usual).at(0), test::read_all(*changed).at(0));
  EXPECT_EQ(facts_of(*changed)[Setting::matrix], stated("matrix bt601"));
}

TEST(VideoColour, ThatIsNotKnownIsNamed) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, test_picture("64x48") + "-colorspace ycgco -color_primaries film clip.mkv");
  std::map<Setting, std::string> notes;
  const auto clip = test::open_test_clip(scratch / "clip.mkv");
  for (const Note& note : clip->info().notes) {
    if (!note.settings.empty()) notes[note.settings.front()] = note.text;
  }
  EXPECT_EQ(notes[Setting::matrix],
            "the file's matrix, ycgco, is not known here and another is taken; state which");
  EXPECT_EQ(notes[Setting::primaries],
            "the file's set of primaries, film, is not known here and another is taken; state which");
}

TEST(VideoColour, IsWhatTheFileSaysAndBeforeThatWhatWasStated) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, test_picture("64x48") +
                          "-vf setsar=32/27 -colorspace bt709 -color_range pc -color_primaries bt2020 "
                          "-color_trc arib-std-b67 clip.mkv");
  const auto clip = test::open_test_clip(scratch / "clip.mkv");
  auto facts = facts_of(*clip);
  EXPECT_EQ(facts[Setting::matrix], from_file("matrix bt709"));
  EXPECT_EQ(facts[Setting::range], from_file("full range"));
  EXPECT_EQ(facts[Setting::primaries], from_file("primaries bt2020"));
  EXPECT_EQ(facts[Setting::transfer], from_file("transfer hlg"));
  EXPECT_EQ(facts[Setting::pixel_aspect], from_file("pixels 32:27"));
  EXPECT_EQ(clip->info().format.primaries, Primaries::bt2020);
  EXPECT_EQ(clip->info().format.pixel_aspect, (Rational{32, 27}));
  const ClipOptions options{{},
                            {},
                            Transfer::pq(),
                            {},
                            YuvMatrix::bt2020,
                            CodeRange::limited,
                            Primaries::p3,
                            parse_pixel_aspect("4:3")};
  const auto other = test::open_test_clip(scratch / "clip.mkv", options);
  facts = facts_of(*other);
  EXPECT_EQ(facts[Setting::matrix], stated("matrix bt2020"));
  EXPECT_EQ(facts[Setting::range], stated("limited range"));
  EXPECT_EQ(facts[Setting::primaries], stated("primaries p3"));
  EXPECT_EQ(facts[Setting::transfer], stated("transfer pq"));
  EXPECT_EQ(facts[Setting::pixel_aspect], stated("pixels 4:3"));
  EXPECT_EQ(other->info().format.transfer, Transfer::pq());
}

// A row of Y, U and V of 10 bits, each as they say.
std::string planes_of(const std::vector<std::array<int, 3>>& yuv) {
  std::string raw;
  for (std::size_t plane = 0; plane < 3; ++plane) {
    for (const auto& pixel : yuv) {
      raw += static_cast<char>(pixel[plane] & 255);
      raw += static_cast<char>(pixel[plane] >> 8);
    }
  }
  return raw;
}

// BT.2100, table 5 and 4, from their words.
double hlg_light(double e) {
  const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * std::log(4 * a);
  return e <= 0.5 ? e * e / 3 : std::min(1.0, (std::exp((e - c) / a) + b) / 12);
}
double pq_light(double e) {
  const double m1 = 0.1593017578125, m2 = 78.84375, c1 = 0.8359375, c2 = 18.8515625, c3 = 18.6875;
  const double power = std::pow(e, 1 / m2);
  return std::pow(std::max(power - c1, 0.0) / (c2 - c3 * power), 1 / m1);
}

// Codes of 16 bits are rounded once: light lies between what half a code less and half a code more stand for.
TEST(VideoColour, OfHighDynamicRangeIsTheLightOfTheStandard) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::Random random(5);
  std::vector<std::array<int, 3>> yuv;
  for (int i = 0; i < 4096; ++i) {
    yuv.push_back({static_cast<int>(random.whole(64, 940)), static_cast<int>(random.whole(400, 624)),
                   static_cast<int>(random.whole(400, 624))});
  }
  scratch.write("raw", planes_of(yuv));
  for (const bool is_hlg : {true, false}) {
    test::make(scratch,
               "-f rawvideo -s 64x64 -pix_fmt yuv444p10le -r 25 -i raw -c:v ffv1 -color_primaries bt2020 "
               "-colorspace bt2020nc -color_range tv -color_trc " +
                   std::string(is_hlg ? "arib-std-b67" : "smpte2084") + " clip.mkv");
    const auto clip = test::open_test_clip(scratch / "clip.mkv");
    const CaptureFormat& format = clip->info().format;
    ASSERT_EQ(format.transfer, is_hlg ? Transfer::hlg() : Transfer::pq());
    ASSERT_EQ(format.primaries, Primaries::bt2020);
    const auto raster = test::read_all(*clip).at(0);
    for (std::size_t i = 0; i < yuv.size(); ++i) {
      // BT.2020's non-constant luminance, limited range of 10 bits.
      const double y = (yuv[i][0] - 64) / 876.0, u = (yuv[i][1] - 512) / 896.0, v = (yuv[i][2] - 512) / 896.0;
      const double red = y + 1.4746 * v, blue = y + 1.8814 * u;
      const double green = (y - 0.2627 * red - 0.0593 * blue) / 0.6780;
      const std::array rgb{red, green, blue};
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const double signal = std::clamp(rgb[channel], 0.0, 1.0);
        const auto light_of = [&](double e) { return is_hlg ? hlg_light(e) : pq_light(e); };
        constexpr double kHalf = 0.5000001 / 65'535;  // and what doubles round
        const double light =
            format.transfer.light_of(test::code_at(format, raster, i * 3 + channel) / 65'535.0);
        ASSERT_GE(light, light_of(std::max(signal - kHalf, 0.0)) * (1 - 1e-9)) << i << ", " << channel;
        ASSERT_LE(light, light_of(std::min(signal + kHalf, 1.0)) * (1 + 1e-9) + 1e-15)
            << i << ", " << channel;
      }
    }
  }
}

// Even patches, so that nobody's way of spreading chroma matters.
TEST(VideoColour, OfEveryMatrixAndRangeIsThatOfZscale) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  if (test::run_shell("ffmpeg -v error -f lavfi -i color=s=16x16:d=0.04 -vf zscale -f null -",
                      scratch.folder())
          .status != 0) {
    GTEST_SKIP() << "this ffmpeg has no zscale";
  }
  constexpr std::size_t kSide = 320, kPatch = 16;
  struct Kind {
    const char *pixels, *rgb;
    int bits;
  };
  test::Random random(6);
  for (const Kind& kind : {Kind{"yuv420p", "gbrp", 8}, Kind{"yuv420p10le", "gbrp10le", 10}}) {
    const std::size_t bytes = kind.bits > 8 ? 2 : 1;
    for (const auto& [matrix, zscale] :
         {std::pair{YuvMatrix::bt601, "170m"}, {YuvMatrix::bt709, "709"}, {YuvMatrix::bt2020, "2020_ncl"}}) {
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
        ClipOptions options;
        options.matrix = matrix;
        options.range = range;
        const auto clip = test::open_test_clip(scratch / "clip.mkv", options);
        const auto raster = test::read_all(*clip).at(0);
        const double white = clip->info().format.white_code, most = (1 << kind.bits) - 1;
        for (std::size_t y = kPatch / 2; y < kSide; y += kPatch) {
          for (std::size_t x = kPatch / 2; x < kSide; x += kPatch) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
              constexpr std::size_t kPlaneOf[] = {2, 0, 1};  // of green, blue, red
              const std::size_t at = (kPlaneOf[channel] * kSide * kSide + y * kSide + x) * bytes;
              const int expected = static_cast<unsigned char>(wanted[at]) +
                                   (bytes == 2 ? static_cast<unsigned char>(wanted[at + 1]) << 8 : 0);
              const double code =
                  test::code_at(clip->info().format, raster, (y * kSide + x) * 3 + channel) / white * most;
              ASSERT_LE(std::fabs(code - expected), 2.0)
                  << kind.pixels << ", " << zscale << ", " << to_text(range) << ", channel " << channel;
            }
          }
        }
      }
    }
  }
}

// Writes another display matrix into an MP4's track header: a, b, c, d of it, as whole numbers.
void set_directions(const std::filesystem::path& path, const std::array<int, 4>& directions) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const std::size_t at =
      bytes.find("tkhd") + 4 + 4 + 36;  // version and flags, then times, number, layer, volume
  ASSERT_LT(at + 36, bytes.size());
  std::string matrix(36, '\0');
  const auto put = [&](std::size_t index, std::int32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
      matrix[index * 4 + i] = static_cast<char>(static_cast<std::uint32_t>(value) >> (24 - 8 * i));
    }
  };
  constexpr std::int32_t kOne = 1 << 16;
  put(0, directions[0] * kOne);
  put(1, directions[1] * kOne);
  put(3, directions[2] * kOne);
  put(4, directions[3] * kOne);
  put(8, 1 << 30);
  file.clear();
  file.seekp(static_cast<std::streamoff>(at));
  file << matrix;
}

// (x, y) of a stored pixel is shown at (a x + c y, b x + d y), moved to where all are positive. Pixels that are not
// square lie down with the picture.
TEST(VideoColour, StandsUprightInAllEightDirections) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch,
             "-f lavfi -i color=black:s=48x32:d=0.04:r=25,drawbox=0:0:16:16:white:fill,setsar=4/3 -c:v ffv1 "
             "-pix_fmt gray clip.mkv");
  test::make(scratch, "-i clip.mkv -c:v mjpeg -q:v 1 -pix_fmt yuvj444p clip.mp4");
  for (const std::array<int, 4>& d : {std::array{1, 0, 0, 1},
                                      {0, 1, -1, 0},
                                      {-1, 0, 0, -1},
                                      {0, -1, 1, 0},
                                      {-1, 0, 0, 1},
                                      {1, 0, 0, -1},
                                      {0, 1, 1, 0},
                                      {0, -1, -1, 0}}) {
    set_directions(scratch / "clip.mp4", d);
    const auto clip = test::open_test_clip(scratch / "clip.mp4");
    const bool lies = d[0] == 0;
    const CaptureFormat& format = clip->info().format;
    ASSERT_EQ(format.shape.width, lies ? 32u : 48u);
    EXPECT_EQ(format.pixel_aspect, lies ? (Rational{3, 4}) : (Rational{4, 3}));
    const auto raster = test::read_all(*clip).at(0);
    const int x = d[0] * 8 + d[2] * 8, y = d[1] * 8 + d[3] * 8;  // of the white square's middle
    const int column = x < 0 ? static_cast<int>(format.shape.width) + x : x;
    const int row = y < 0 ? static_cast<int>(format.shape.height) + y : y;
    for (int cell_y = 8; cell_y < static_cast<int>(format.shape.height); cell_y += 16) {
      for (int cell_x = 8; cell_x < static_cast<int>(format.shape.width); cell_x += 16) {
        const auto at =
            static_cast<std::uint64_t>(cell_y) * format.shape.width + static_cast<std::uint64_t>(cell_x);
        EXPECT_EQ(test::code_at(format, raster, at * 3) > 128, cell_x == column && cell_y == row)
            << d[0] << d[1] << d[2] << d[3] << " at " << cell_x << "," << cell_y;
      }
    }
  }
}

}  // namespace
}  // namespace nutik
