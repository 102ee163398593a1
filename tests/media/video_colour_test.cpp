// What a video's codes are taken for: matrix, range, transfer function, primaries, shape and direction of its pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

std::string test_picture(const std::string& size) {
  return "-f lavfi -i testsrc2=s=" + size + ":d=0.08:r=25 -c:v ffv1 -pix_fmt yuv420p ";
}

TEST(VideoColour, OfFilesThatSayNothingDependsOnTheirLines) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, test_picture("64x720") + "high.mkv");
  test::make(scratch, test_picture("64x718") + "-color_range unknown low.mkv");
  EXPECT_EQ(facts_of(*open_test_clip(scratch / "high.mkv")).at(Setting::matrix).line(), "matrix bt709, assumed");
  EXPECT_EQ(facts_of(*open_test_clip(scratch / "low.mkv")).at(Setting::matrix).line(), "matrix bt601, assumed");
  EXPECT_EQ(facts_of(*open_test_clip(scratch / "low.mkv")).at(Setting::range).line(), "limited range, assumed");
  EXPECT_EQ(facts_of(*open_test_clip(scratch / "low.mkv")).at(Setting::transfer).line(), "transfer srgb, assumed");
  test::make(scratch, "-i low.mkv -c:v prores_ks -bsf:v prores_metadata=color_primaries=unknown:color_trc=unknown:"
                      "colorspace=unknown pro.mov");
  EXPECT_EQ(facts_of(*open_test_clip(scratch / "pro.mov")).at(Setting::matrix).line(), "matrix bt601, assumed");
  // It matters: the codes are those of the matrix that was taken.
  const auto usual = open_test_clip(scratch / "high.mkv"),
             changed = open_test_clip(scratch / "high.mkv", {.matrix = YuvMatrix::bt601});
  EXPECT_NE(read_all(*usual).at(0), read_all(*changed).at(0));
  EXPECT_EQ(facts_of(*changed).at(Setting::matrix).line(), "matrix bt601, as stated");
}

TEST(VideoColour, ThatIsNotKnownIsNamed) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, test_picture("64x48") + "-color_primaries film clip.mkv");
  const auto clip = open_test_clip(scratch / "clip.mkv");
  ASSERT_EQ(clip->info().notes.size(), 1u);
  EXPECT_EQ(clip->info().notes[0].text,
            "the file's set of primaries, film, is not known here and another is taken; state which");
  EXPECT_EQ(clip->info().notes[0].settings, std::vector{Setting::primaries});
}

TEST(VideoColour, IsWhatTheFileSaysAndBeforeThatWhatWasStated) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const auto& [encoder, note] :
       {std::pair("ffv1", ""),
        {"libx265 -x265-params log-level=0",
         "the container names full range, and by its pictures it would be limited range: the container's count"},
        {"libx264 -x264-params colormatrix=fcc:colorprim=bt709:transfer=bt709:range=tv",
         "the container names full range, matrix bt709, transfer hlg, primaries bt2020, and by its pictures it would "
         "be limited range, matrix fcc, transfer bt709, primaries bt709: the container's count"}}) {
    test::make(scratch, test_picture("64x48") + "-c:v " + std::string(encoder) +
                            " -vf setsar=32/27 -colorspace bt709 -color_range pc -color_primaries bt2020 "
                            "-color_trc arib-std-b67 clip.mkv");
    const auto clip = open_test_clip(scratch / "clip.mkv");
    auto facts = facts_of(*clip);
    EXPECT_EQ(facts.at(Setting::matrix).line(), "matrix bt709, from the file");
    EXPECT_EQ(facts.at(Setting::range).line(), "full range, from the file");
    EXPECT_EQ(facts.at(Setting::primaries).line(), "primaries bt2020, from the file");
    EXPECT_EQ(facts.at(Setting::transfer).line(), "transfer hlg, from the file");
    EXPECT_EQ(facts.at(Setting::pixel_aspect).line(), "pixels 32:27, from the file");
    EXPECT_EQ(clip->info().format.primaries, Primaries::bt2020);
    EXPECT_EQ(clip->info().format.pixel_aspect, (Rational{32, 27}));
    EXPECT_EQ(read_all(*clip).size(), 2u);
    const auto& notes = clip->info().notes;
    EXPECT_TRUE(*note == 0 ? notes.empty() : notes.at(0).text.starts_with(note)) << encoder << notes.size();
  }
  const ClipOptions options{{},
                            {},
                            Transfer::pq(),
                            {},
                            YuvMatrix::bt2020,
                            CodeRange::limited,
                            std::nullopt,
                            Primaries::p3,
                            parse_pixel_aspect("4:3")};
  const auto other = open_test_clip(scratch / "clip.mkv", options);
  auto facts = facts_of(*other);
  EXPECT_EQ(facts.at(Setting::matrix).line(), "matrix bt2020, as stated");
  EXPECT_EQ(facts.at(Setting::range).line(), "limited range, as stated");
  EXPECT_EQ(facts.at(Setting::primaries).line(), "primaries p3, as stated");
  EXPECT_EQ(facts.at(Setting::transfer).line(), "transfer pq, as stated");
  EXPECT_EQ(facts.at(Setting::pixel_aspect).line(), "pixels 4:3, as stated");
  EXPECT_EQ(other->info().format.transfer, Transfer::pq());
}

// BT.709's curve is what everyday cameras name, whatever theirs is; nobody names another by mistake.
TEST(VideoColour, OfEightBitsIsBelievedButForTheCurveOfCameras) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const auto& [named, taken] : {std::pair("iec61966-2-1", "transfer srgb, from the file"),
                                     {"linear", "transfer linear, from the file"},
                                     {"bt709", "transfer srgb, assumed; the file names bt709"}}) {
    test::make(scratch, test_picture("64x48") + "-color_trc " + std::string(named) + " -y clip.mkv");
    EXPECT_EQ(facts_of(*open_test_clip(scratch / "clip.mkv")).at(Setting::transfer).line(), taken) << named;
  }
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
  Random random(5);
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
    const auto clip = open_test_clip(scratch / "clip.mkv");
    const CaptureFormat& format = clip->info().format;
    ASSERT_EQ(format.transfer, is_hlg ? Transfer::hlg() : Transfer::pq());
    ASSERT_EQ(format.primaries, Primaries::bt2020);
    const auto raster = read_all(*clip).at(0);
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
        const double light = format.transfer.light_of(code_at(format, raster, i * 3 + channel) / 65'535.0);
        ASSERT_GE(light, light_of(std::max(signal - kHalf, 0.0)) * (1 - 1e-9)) << i << ", " << channel;
        ASSERT_LE(light, light_of(std::min(signal + kHalf, 1.0)) * (1 + 1e-9) + 1e-15)
            << i << ", " << channel;
      }
    }
  }
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
    set_display_matrix(scratch / "clip.mp4", {1.0 * d[0], 1.0 * d[1], 1.0 * d[2], 1.0 * d[3]});
    const auto clip = open_test_clip(scratch / "clip.mp4");
    const bool lies = d[0] == 0;
    const CaptureFormat& format = clip->info().format;
    ASSERT_EQ(format.shape.width, lies ? 32u : 48u);
    EXPECT_EQ(format.pixel_aspect, lies ? (Rational{3, 4}) : (Rational{4, 3}));
    const auto raster = read_all(*clip).at(0);
    const int x = d[0] * 8 + d[2] * 8, y = d[1] * 8 + d[3] * 8;  // of the white square's middle
    const int column = x < 0 ? static_cast<int>(format.shape.width) + x : x;
    const int row = y < 0 ? static_cast<int>(format.shape.height) + y : y;
    for (int cell_y = 8; cell_y < static_cast<int>(format.shape.height); cell_y += 16) {
      for (int cell_x = 8; cell_x < static_cast<int>(format.shape.width); cell_x += 16) {
        const auto at =
            static_cast<std::uint64_t>(cell_y) * format.shape.width + static_cast<std::uint64_t>(cell_x);
        EXPECT_EQ(code_at(format, raster, at * 3) > 128, cell_x == column && cell_y == row)
            << d[0] << d[1] << d[2] << d[3] << " at " << cell_x << "," << cell_y;
      }
    }
  }
  // H.264 says it itself, as well.
  test::make(scratch, "-i clip.mkv -c:v libx264 -pix_fmt yuv420p "
                      "-bsf:v h264_metadata=display_orientation=insert:rotate=90 turned.mkv");
  const auto turned = open_test_clip(scratch / "turned.mkv");
  EXPECT_EQ(turned->info().format.shape, (Shape{32, 48, 3}));
  EXPECT_EQ(turned->info().format.pixel_aspect, (Rational{3, 4}));
  const auto raster = read_all(*turned).at(0);
  for (const std::size_t row : {8u, 40u})  // at the bottom left
    EXPECT_EQ(code_at(turned->info().format, raster, (row * 32 + 8) * 3) > 128, row == 40);
}

// What a camera put into the 16 bits of grey video is not known.
TEST(VideoColour, TellsWhatWhiteIsTakenToBe) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const auto& [pixels, line, notes] :
       {std::tuple("gray12le", "white 4095, from the file", 0u), {"gray16le", "white 65535, assumed", 1u}}) {
    test::make(scratch, "-f lavfi -i testsrc2=s=32x32:r=25:d=0.1 -c:v ffv1 -pix_fmt " + std::string(pixels) +
                            " clip.mkv");
    const auto clip = open_test_clip(scratch / "clip.mkv");
    EXPECT_EQ(facts_of(*clip).at(Setting::white_code).line(), line);
    ASSERT_EQ(clip->info().notes.size(), notes) << pixels;
    for (const Note& note : clip->info().notes) EXPECT_EQ(note.settings, std::vector{Setting::white_code});
  }
  const auto stated = open_test_clip(scratch / "clip.mkv", {.white_code = 4095});
  EXPECT_EQ(facts_of(*stated).at(Setting::white_code).line(), "white 4095, as stated");
  EXPECT_TRUE(stated->info().notes.empty());
}

// Nearest codes, worked out in whole numbers.
TEST(VideoColour, OfGreyAndRgbInTheLimitedRangeIsScaledToTheFullOne) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const auto& [pixels, bits, white, channels] : {std::tuple("gray", 8, 255L, 1u), {"gray10le", 10, 65'535L, 1u},
                                                      {"gbrp", 8, 255L, 3u}, {"gbrp10le", 10, 65'535L, 3u}}) {
    std::string raw;
    for (int code = 0; code < 1 << bits; ++code) {
      raw += static_cast<char>(code & 255);
      if (bits > 8) raw += static_cast<char>(code >> 8);
    }
    scratch.write("raw", channels == 1 ? raw : raw + raw + raw);
    const std::string words = from_raw({32, (1u << bits) / 32, 1}, pixels) + "-c:v ffv1 ";
    test::make(scratch, words + "bare.mkv");
    test::make(scratch, words + "-color_range tv limited.mkv");
    const auto codes_of = [&](const char* name, std::optional<CodeRange> range, const std::string& fact) {
      const auto clip = open_test_clip(scratch / name, {.range = range});
      const auto facts = facts_of(*clip);
      EXPECT_EQ(facts.contains(Setting::range) ? facts.at(Setting::range).line() : "", fact) << name;
      std::vector<long> codes;
      const auto raster = read_all(*clip).at(0);
      for (std::size_t i = 0; i < std::size_t{1} << bits; ++i)
        codes.push_back(code_at(clip->info().format, raster, i * channels));
      return codes;
    };
    const long unit = 1 << (bits - 8);
    std::vector<long> full, scaled;
    for (long code = 0; code < 1 << bits; ++code) {
      full.push_back(code);
      scaled.push_back(std::clamp((2 * (code - 16 * unit) * white + 219 * unit) / (2 * 219 * unit), 0L, white));
    }
    EXPECT_EQ(codes_of("bare.mkv", CodeRange::limited, "limited range, as stated"), scaled);
    if (channels == 3) {
      expect_clip_refused(scratch / "limited.mkv", {}, "names the limited range, which some encoders write");
      EXPECT_EQ(codes_of("limited.mkv", CodeRange::full, "full range, as stated"), codes_of("bare.mkv", {}, ""));
      continue;
    }
    EXPECT_EQ(codes_of("limited.mkv", {}, "limited range, from the file"), scaled);
    EXPECT_EQ(codes_of("bare.mkv", {}, ""), full);
    EXPECT_EQ(codes_of("limited.mkv", CodeRange::full, "full range, as stated"), full);
    expect_clip_refused(scratch / "limited.mkv", {.white_code = 4095}, "scaled to the full one, whose white is ");
  }
}

TEST(VideoColour, ThatChangesInMidClipIsRefused) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const auto clip_of = [&](const std::string& change, const std::string& pixels = "yuv420p") {
    test::make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25:d=1 -c:v libx264 -bf 0 -pix_fmt " + pixels +
                            " -bsf:v h264_metadata=sample_aspect_ratio=1:colour_primaries=1:video_full_range_flag=0:"
                            "matrix_coefficients=1:transfer_characteristics=1" + change + " part.ts");
    return read_file(scratch / "part.ts");
  };
  const std::string first = clip_of("");
  for (const auto& [second, said] :
       {std::pair(clip_of(":video_full_range_flag=1"),
                  "picture 25 is of the full range, the ones before it of the limited range"),
        {clip_of(":matrix_coefficients=6"), "picture 25 is of matrix bt601, the ones before it of matrix bt709"},
        {clip_of(":transfer_characteristics=16"), "picture 25 is of transfer pq, the ones before it of transfer srgb"},
        {clip_of(":colour_primaries=9"), "picture 25 is of primaries bt2020, the ones before it of primaries bt709"},
        {clip_of(":sample_aspect_ratio=2"), "picture 25 is of pixels 2:1, the ones before it of square pixels"},
        {clip_of("", "yuv420p10le"), "picture 25 is of YUV of 10 bits, the ones before it of YUV of 8 bits"},
        {clip_of(":transfer_characteristics=6"), ""}}) {
    ClipOptions options{.rate = Rational{25, 1}};
    const auto path = scratch.write("joined.ts", first + second);
    if (*said != 0) expect_clip_refused(path, options, said);
    options.ends_at_damage = true;
    EXPECT_EQ(read_all(*open_test_clip(path, options)).size(), *said == 0 ? 50u : 25u) << said;
    options.range = CodeRange::limited;
    options.matrix = YuvMatrix::bt709;
    options.transfer = Transfer::srgb();
    options.primaries = Primaries::bt709;
    options.pixel_aspect = Rational{1, 1};
    const bool is_of_pixels = std::string_view(said).ends_with("bits");
    EXPECT_EQ(read_all(*open_test_clip(path, options)).size(), is_of_pixels ? 25u : 50u) << "as stated";
  }
}

// What comes before a part is not decoded.
TEST(VideoColour, ThatChangesBeforeAPartIsRefused) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const std::string make = "-f lavfi -i testsrc2=s=64x48:r=25:d=1 -c:v mjpeg -aspect ";
  test::make(scratch, make + "4:3 a.mjpeg");
  test::make(scratch, make + "8:3 b.mjpeg");
  scratch.write("joined.mjpeg", read_file(scratch / "a.mjpeg") + read_file(scratch / "b.mjpeg"));
  ClipOptions options;
  options.rate = Rational{25, 1};
  options.from = ClipMoment{30, true};
  expect_clip_refused(scratch / "joined.mjpeg", options,
                      "picture 30 is of pixels 2:1, the ones before it of square pixels");
}

TEST(VideoColour, TellsOfTransparencyWhereThereIsSome) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const auto& [words, is_told] :
       {std::pair("testsrc2=s=32x32:r=25:d=0.2' opaque.gif", false),
        {"color=red@0:s=32x32:r=25:d=0.2,format=rgba,split[a][b];[a]palettegen[p];[b][p]paletteuse' clear.gif", true},
        {"testsrc2=s=32x32:r=25:d=0.2,split[a][b];[a]palettegen=reserve_transparent=0[p];[b][p]paletteuse' "
         "-c:v rawvideo opaque.avi", false},
        {"color=black:s=32x32:r=25:d=0.2' -pix_fmt pal8 -c:v rawvideo black.nut", false},
        {"testsrc2=s=32x32:r=25:d=0.2' -c:v libvpx-vp9 -pix_fmt yuva420p clear.webm", true}}) {
    test::make(scratch, "-f lavfi -i '" + std::string(words));
    const auto clip = open_test_clip(scratch / std::string(words).substr(std::string(words).rfind(' ') + 1));
    read_all(*clip);
    auto told = clip->remarks();
    told.insert(told.end(), clip->info().notes.begin(), clip->info().notes.end());
    EXPECT_EQ(std::ranges::count(told, "the file's transparency is left out", &Note::text), is_told) << words;
  }
  scratch.write("raw", std::string(32 * 32, 'a') + std::string(1024, '\0'));
  test::make(scratch, from_raw({32, 32, 1}, "pal8") + "-c:v rawvideo bare.nut");
  expect_error<InputError>([&] { read_all(*open_test_clip(scratch / "bare.nut")); }, {"the file has no palette"});
}

// 32 x 32 pixels, of which so many have a luma of `code`, the others that of white.
TEST(VideoColour, TellsOfLightAboveTheWhiteOfTheLimitedRange) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const std::string pixels : {"yuv444p", "yuv420p", "yuv422p10le", "uyvy422", "gray", "gray12le", "gbrp"}) {
    const auto told = [&](int bright, int code, CodeRange range = CodeRange::limited) {
      std::string raw(std::size_t{32} * 32, static_cast<char>(235));
      std::fill_n(raw.begin(), bright, static_cast<char>(code));
      scratch.write("raw", raw);
      // Luma, and RGB, are these codes at any depth.
      test::make(scratch, from_raw({32, 32, 1}, "gray") + "-c:v rawvideo -vf " +
                              (pixels == "gbrp" ? "extractplanes=y,format=gray,mergeplanes=0x000000:gbrp"
                                                : "scale=in_range=tv:out_range=tv,format=" + pixels) + " clip.nut");
      const auto clip = open_test_clip(scratch / "clip.nut", {.range = range});
      read_all(*clip);
      return clip->remarks();
    };
    EXPECT_TRUE(told(1024, 235).empty()) << pixels;
    EXPECT_TRUE(told(1, 254).empty()) << pixels;  // less than a thousandth
    EXPECT_TRUE(told(512, 254, CodeRange::full).empty()) << pixels;
    const auto remarks = told(512, 237);
    ASSERT_EQ(remarks.size(), 1u) << pixels;
    EXPECT_TRUE(remarks[0].is_warning);
    expect_says(remarks[0].text, "cut off in up to 50 % of a picture (pictures with at least 0.1 %: 1), and bounds");
  }
}

// What it advises makes the light that was cut off.
TEST(VideoColour, KeepsLightAboveWhiteByTheAdvisedCommand) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  scratch.write("raw", std::string(1024, static_cast<char>(250)) + std::string(2048, static_cast<char>(128)));
  const std::string words = from_raw({32, 32, 1}, "yuv444p") + "-c:v ffv1 ";
  test::make(scratch, words + "clip.mkv");
  const auto told = [&](const ClipOptions& options) {
    const auto clip = open_test_clip(scratch / "clip.mkv", options);
    read_all(*clip);
    return clip->remarks().at(0);
  };
  const Note assumed = told({});
  EXPECT_TRUE(assumed.text.ends_with("; if the clip is of the full range, say so")) << assumed.text;
  EXPECT_EQ(assumed.settings, std::vector{Setting::range});
  EXPECT_EQ(told({.transfer = Transfer::bt709(), .range = CodeRange::limited}).text.find("ffmpeg"), std::string::npos);
  for (const char* tags : {"", "-color_range tv -colorspace bt709 -color_trc bt709 -color_primaries bt709 "}) {
    test::make(scratch, words + tags + "clip.mkv");
    const std::string text = told({.range = CodeRange::limited}).text;
    const std::size_t begin = text.find("-i CLIP"), end = text.find(" keeps it, at half of all light");
    ASSERT_LT(begin, end) << text;
    test::make(scratch, "-i clip.mkv" + text.substr(begin + 7, end - begin - 7));
    const auto clip = open_test_clip(scratch / "darker.mkv");
    const double signal = (250 - 16) / 219.0, light = std::pow((signal + 0.055) / 1.055, 2.4);
    const CaptureFormat& format = clip->info().format;
    EXPECT_NEAR(format.transfer.light_of(code_at(format, read_all(*clip).at(0), 0) / 65'535.0), light / 2, 2e-4);
  }
}

TEST(VideoColour, OfDigitalCinemaIsRefusedWithItsWayOut) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, "-f lavfi -i color=0x4080C0:s=32x32:r=25:d=0.1 -c:v rawvideo -pix_fmt xyz12le clip.nut");
  expect_clip_refused(scratch / "clip.nut", {}, "holds X'Y'Z' of digital cinema");
  test::make(scratch, "-i clip.nut -pix_fmt gbrp16le -color_trc gamma22 -color_primaries bt709 -c:v ffv1 film.mkv");
  const auto clip = open_test_clip(scratch / "film.mkv");
  EXPECT_EQ(clip->info().format.transfer, Transfer::parse("gamma:2.2"));
  const auto raster = read_all(*clip).at(0);
  for (std::size_t i = 0; i < 3; ++i)  // by less than sRGB's curve is off from that
    EXPECT_NEAR(code_at(clip->info().format, raster, i) / 257.0, 64.0 * static_cast<double>(i + 1), 4.0) << i;
}

// Frames are whole where nothing says that they are interlaced; that something says so is no assumption.
TEST(VideoColour, TellsThatFramesAreAssumedToBeWhole) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const auto facts = [&](const std::string& words) {
    test::make(scratch, "-f lavfi -i testsrc2=s=32x32:r=25:d=0.1 " + words);
    return facts_of(*open_test_clip(scratch / words.substr(words.rfind(' ') + 1)));
  };
  EXPECT_EQ(facts("-c:v rawvideo -pix_fmt yuv420p clip.avi").at(Setting::deinterlace).line(),
            "progressive frames, assumed");
  EXPECT_FALSE(facts("-c:v ffv1 -pix_fmt yuv420p clip.mkv").contains(Setting::deinterlace));
}

TEST(VideoColour, TellsWhichPrimariesCountAsOthers) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const auto& [named, line] :
       {std::pair("smpte170m", "primaries bt709, from the file; it names smpte170m"),
        {"bt709", "primaries bt709, from the file"},
        {"smpte431", "primaries dci-p3, from the file"},
        {"smpte432", "primaries p3, from the file"}}) {
    test::make(scratch,
               "-f lavfi -i testsrc2=s=32x32:r=25:d=0.1 -c:v ffv1 -pix_fmt yuv420p -color_primaries " +
                   std::string(named) + " clip.mkv");
    EXPECT_EQ(facts_of(*open_test_clip(scratch / "clip.mkv")).at(Setting::primaries).line(), line);
  }
}

}  // namespace
}  // namespace nutik::test
