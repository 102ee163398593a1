// Video whose depth or times OpenCV's reader would lose: codes, white, transfer and times.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "capture/error.hpp"
#include "support/clips.hpp"
#include "support/program.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik {
namespace {

using test::difference;
using test::open_test_clip;
using test::read_all;
using test::Scratch;

constexpr Shape kGrey{17, 9, 1}, kColour{17, 9, 3};

bool has_ffmpeg() {
  const Scratch scratch;
  return test::run_shell("ffmpeg -version", scratch.folder()).status == 0;
}

#define NEEDS_FFMPEG() \
  if (!has_ffmpeg()) GTEST_SKIP() << "the ffmpeg command is missing, which makes the clips"

std::string bytes_of(const std::vector<Picture>& pictures) {
  std::string bytes;
  for (const Picture& picture : pictures) {
    bytes.append(reinterpret_cast<const char*>(picture.bytes.data()), picture.bytes.size());
  }
  return bytes;
}

std::string with_bytes_swapped(std::string bytes) {
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  return bytes;
}

ClipOptions raw_options(Shape shape, const std::string& pixels) {
  ClipOptions options;
  options.raw = RawVideo{shape.width, shape.height, pixels};
  options.rate = Rational{25, 1};
  return options;
}

// Runs ffmpeg in the scratch folder.
void make(const Scratch& scratch, const std::string& words) {
  const auto made = test::run_shell("ffmpeg -v error -y " + words, scratch.folder());
  ASSERT_EQ(made.status, 0) << words << "\n" << made.err;
}

std::string from_raw(Shape shape, const std::string& pixels) {
  return "-f rawvideo -s " + std::to_string(shape.width) + "x" + std::to_string(shape.height) +
         " -r 25 -pix_fmt " + pixels + " -i raw ";
}

void expect_codes(Clip& clip, const std::vector<Picture>& pictures) {
  ASSERT_EQ(clip.info().format.shape, pictures[0].shape);
  ASSERT_EQ(clip.info().format.white_code, pictures[0].white_code);
  const auto rasters = read_all(clip);
  ASSERT_EQ(rasters.size(), pictures.size());
  for (std::size_t k = 0; k < pictures.size(); ++k)
    EXPECT_EQ(difference(rasters[k], pictures[k]), "") << k;
}

void expect_refused(const std::filesystem::path& path, const ClipOptions& options,
                    const std::string& part) {
  try {
    const auto clip = open_test_clip(path, options);
    const auto rasters = read_all(*clip);
    static_cast<void>(timeline_of(path.string(), clip->info(), options, {360, 1}, rasters.size()));
    FAIL() << path << " was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(VideoClip, KeepsGreyCodeForCode) {
  NEEDS_FFMPEG();
  struct Depth {
    std::string pixels;
    std::uint32_t white;
  };
  for (const auto& [pixels, white] :
       {Depth{"gray", 255}, {"gray10le", 1023}, {"gray12le", 4095}, {"gray16le", 65'535}}) {
    SCOPED_TRACE(pixels);
    const Scratch scratch;
    const auto pictures = test::random_stills(kGrey, white, 4, white);
    scratch.write("raw", bytes_of(pictures));
    make(scratch, from_raw(kGrey, pixels) + "-c:v ffv1 -pix_fmt " + pixels + " clip.mkv");
    const auto clip = open_test_clip(scratch / "clip.mkv");
    EXPECT_EQ(clip->info().format.transfer, white == 255 ? Transfer::srgb() : Transfer::linear());
    EXPECT_EQ(clip->info().timing.rate, (Rational{25, 1}));
    expect_codes(*clip, pictures);
  }
}

TEST(VideoClip, ReadsRawVideoOfEveryKind) {
  struct Kind {
    std::string pixels;
    Shape shape;
    std::uint32_t white;
    bool swapped;
  };
  const Kind kinds[] = {{"gray", kGrey, 255, false},
                        {"gray9le", kGrey, 511, false},
                        {"gray10be", kGrey, 1023, true},
                        {"gray12be", kGrey, 4095, true},
                        {"gray14le", kGrey, 16'383, false},
                        {"gray14be", kGrey, 16'383, true},
                        {"gray16be", kGrey, 65'535, true},
                        {"rgb24", kColour, 255, false},
                        {"rgb48le", kColour, 65'535, false},
                        {"rgb48be", kColour, 65'535, true},
                        {"rgb24", {1, 1, 3}, 255, false},
                        {"gray12le", {1, 1, 1}, 4095, false},
                        {"rgb48le", {67, 33, 3}, 65'535, false}};
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.pixels);
    const Scratch scratch;
    const auto pictures = test::random_stills(kind.shape, kind.white, 3, kind.white);
    std::string bytes = bytes_of(pictures);
    if (kind.swapped) bytes = with_bytes_swapped(bytes);
    expect_codes(*open_test_clip(scratch.write("raw", bytes), raw_options(kind.shape, kind.pixels)),
                 pictures);
  }
}

// What is no code of its own is converted: one bit to black and white, subsampled 8-bit colour to
// RGB.
TEST(VideoClip, ConvertsOtherRawKinds) {
  const Scratch scratch;
  const auto bits =
      open_test_clip(scratch.write("bits", "\xA5\x80\x5A\x7F"), raw_options({16, 2, 1}, "monob"));
  EXPECT_EQ(bits->info().format.white_code, 255u);
  const auto raster = read_all(*bits).at(0);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_EQ(std::to_integer<int>(raster[i]), 0xA5 >> (7 - i) & 1 ? 255 : 0);

  // Y 235, U and V 128 are white; odd sizes have a last column and row of colour of their own.
  for (const Shape shape : {Shape{16, 8, 3}, Shape{17, 9, 3}}) {
    const std::size_t luma = shape.pixel_count();
    const std::size_t chroma = std::size_t{(shape.width + 1) / 2} * ((shape.height + 1) / 2);
    const std::string white = std::string(luma, '\xEB') + std::string(2 * chroma, '\x80');
    const auto clip = open_test_clip(scratch.write("yuv", white), raw_options(shape, "yuv420p"));
    EXPECT_EQ(clip->info().format.code_bytes, 1u);
    const auto codes = read_all(*clip).at(0);
    for (const std::byte code : codes) EXPECT_EQ(std::to_integer<int>(code), 255);
  }
}

TEST(VideoClip, SpreadsDeepRgbOverSixteenBits) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  // As planes: green, blue, red.
  const Picture planes = test::random_stills({17, 27, 1}, 1023, 1, 4)[0];
  scratch.write("raw", bytes_of({planes}));
  make(scratch, from_raw(kGrey, "gbrp10le") + "-c:v ffv1 -pix_fmt gbrp10le clip.mkv");
  const auto clip = open_test_clip(scratch / "clip.mkv");
  EXPECT_EQ(clip->info().format.white_code, 65'535u);
  EXPECT_EQ(clip->info().format.transfer, Transfer::srgb());
  const auto raster = read_all(*clip).at(0);
  const auto* codes = reinterpret_cast<const std::uint16_t*>(raster.data());
  for (std::size_t i = 0; i < kGrey.pixel_count(); ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::size_t plane = channel == 0 ? 2 : channel - 1;
      const unsigned code = planes.values<std::uint16_t>()[plane * kGrey.pixel_count() + i];
      ASSERT_EQ(codes[i * 3 + channel], code << 6 | code >> 4);
    }
  }
}

// Against the standards' own equations. libswscale's coefficients have 16 bits and its sums
// about 19.
TEST(VideoClip, TurnsYuvIntoRgbByTheMatrixTheFileNames) {
  NEEDS_FFMPEG();
  struct Colours {
    const char* space;
    const char* range;
    double red, blue;  // the matrix's weights
    bool full;
  };
  for (const Colours& colours : {Colours{"bt709", "tv", 0.2126, 0.0722, false},
                                 {"smpte170m", "tv", 0.299, 0.114, false},
                                 {"bt709", "pc", 0.2126, 0.0722, true},
                                 {"bt2020nc", "tv", 0.2627, 0.0593, false}}) {
    SCOPED_TRACE(std::string(colours.space) + " " + colours.range);
    const Scratch scratch;
    test::Random random(5);
    std::vector<Picture> planes{Picture({17, 27, 1}, ValueType::code16, 1023)};
    const std::size_t count = kGrey.pixel_count();
    auto codes = planes[0].values<std::uint16_t>();
    for (std::size_t i = 0; i < 3 * count; ++i) {
      // Colours near grey, so that hardly any lies outside RGB.
      codes[i] =
          static_cast<std::uint16_t>(i < count ? random.whole(200, 800) : random.whole(452, 572));
    }
    scratch.write("raw", bytes_of(planes));
    make(scratch, from_raw(kGrey, "yuv444p10le") + "-c:v ffv1 -pix_fmt yuv444p10le -colorspace " +
                      colours.space + " -color_range " + colours.range + " clip.mkv");
    const auto raster = read_all(*open_test_clip(scratch / "clip.mkv")).at(0);
    const auto* rgb = reinterpret_cast<const std::uint16_t*>(raster.data());
    double worst = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double y = colours.full ? codes[i] / 1023.0 : (codes[i] - 64) / 876.0;
      const double scale = colours.full ? 1023.0 : 896.0;
      const double u = (codes[count + i] - 512) / scale, v = (codes[2 * count + i] - 512) / scale;
      const double red = y + 2 * (1 - colours.red) * v, blue = y + 2 * (1 - colours.blue) * u;
      const double green =
          (y - colours.red * red - colours.blue * blue) / (1 - colours.red - colours.blue);
      const double want[] = {red, green, blue};
      for (std::size_t channel = 0; channel < 3; ++channel) {
        worst = std::max(
            worst, std::abs(rgb[i * 3 + channel] - 65'535 * std::clamp(want[channel], 0.0, 1.0)));
      }
    }
    EXPECT_LE(worst, 0.5 + 1e-6);
  }
}

// Subsampled colour gets its U and V from its neighbours; its luma keeps every bit.
TEST(VideoClip, KeepsTheDepthOfSubsampledLuma) {
  for (const auto& [pixels, share] :
       {std::pair<std::string, std::size_t>{"yuv420p10le", 4}, {"yuv422p10le", 2}}) {
    const Scratch scratch;
    const Shape shape{64, 16, 3};
    std::string bytes;
    const auto add = [&](int code) {
      bytes += static_cast<char>(code & 0xFF);
      bytes += static_cast<char>(code >> 8);
    };
    for (int i = 0; i < 1024; ++i) add(i);
    for (std::size_t i = 0; i < 2 * 1024 / share; ++i) add(512);
    const auto raster =
        read_all(*open_test_clip(scratch.write("raw", bytes), raw_options(shape, pixels))).at(0);
    const auto* rgb = reinterpret_cast<const std::uint16_t*>(raster.data());
    for (int i = 0; i < 1024; ++i) {
      const long want = std::lround(65'535 * std::clamp((i - 64) / 876.0, 0.0, 1.0));
      for (int channel = 0; channel < 3; ++channel) ASSERT_EQ(rgb[3 * i + channel], want) << i;
    }
  }
}

TEST(VideoClip, RefusesWhatItCannotKeep) {
  const Scratch scratch;
  const auto file = scratch.write("raw", std::string(17 * 9 * 4, '\0'));
  expect_refused(file, raw_options(kGrey, "grayf32le"), "holds floating-point pixels (grayf32le)");
  expect_refused(
      file, raw_options({17, 8, 1}, "gray"),
      "612 bytes, which is no whole number of pictures of 136 bytes (17 x 8, gray); check --raw");
  expect_refused(file, raw_options(kGrey, "grey"), "'grey' is no pixel format that FFmpeg knows");
  expect_refused(scratch.write("empty", ""), raw_options(kGrey, "gray"), "0 bytes");
  ClipOptions without_rate = raw_options(kGrey, "gray");
  without_rate.rate.reset();
  expect_refused(file, without_rate,
                 "raw does not say how fast it was taken; state the rate with --fps");
  ClipOptions with_white = raw_options(kColour, "rgb48le");
  with_white.white_code = 1023;
  expect_refused(scratch.write("rgb", std::string(17 * 9 * 6, '\0')), with_white,
                 "--white 1023: colour video is converted to RGB, whose white is 65535");
}

TEST(VideoClip, SaysThatATransferFunctionIsNotKnown) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  scratch.write("raw", bytes_of(test::random_stills({17, 27, 1}, 1023, 1, 4)));
  for (const auto& [name, known] :
       {std::pair<std::string, bool>{"bt709", true}, {"smpte2084", false}}) {
    make(scratch, from_raw(kGrey, "yuv444p10le") + "-c:v ffv1 -pix_fmt yuv444p10le -color_trc " +
                      name + " clip.mkv");
    const auto clip = open_test_clip(scratch / "clip.mkv");
    EXPECT_EQ(clip->info().format.transfer, known ? Transfer::bt709() : Transfer::srgb());
    ASSERT_EQ(clip->info().notes.size(), known ? 0u : 1u);
    if (known) continue;
    EXPECT_NE(clip->info().notes[0].find("transfer function, smpte2084, is not known"),
              std::string::npos);
  }
}

TEST(VideoClip, StandsUprightAsPlayersShowIt) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  scratch.write("raw", bytes_of(test::random_stills({16, 8, 1}, 4095, 2, 4)));
  make(scratch, from_raw({16, 8, 1}, "gray12le") + "-c:v ffv1 -pix_fmt gray12le flat.mov");
  for (const int angle : {0, 90, 180, 270}) {
    make(scratch,
         "-i flat.mov -c copy -metadata:s:v rotate=" + std::to_string(angle) + " clip.mov");
    make(scratch, "-i clip.mov -f rawvideo -pix_fmt gray12le shown");  // ffmpeg turns it, too
    const auto clip = open_test_clip(scratch / "clip.mov");
    const bool swapped = angle % 180 != 0;
    EXPECT_EQ(clip->info().format.shape, (Shape{swapped ? 8u : 16u, swapped ? 16u : 8u, 1}));
    std::string got;
    for (const auto& raster : read_all(*clip))
      got.append(reinterpret_cast<const char*>(raster.data()), raster.size());
    EXPECT_EQ(got, test::read_file(scratch / "shown")) << angle;
  }
}

// Times in ms, that fit no rate.
const std::vector<std::int64_t> kStarts{0, 40, 80, 120, 240, 250, 490};

void make_irregular(const Scratch& scratch, const std::string& output, const std::string& codec) {
  const auto pictures = test::random_stills({32, 16, 1}, 255, static_cast<int>(kStarts.size()), 2);
  scratch.write("raw", bytes_of(pictures));
  std::string times;
  for (std::size_t k = 0; k < kStarts.size(); ++k) {
    times += (k == 0 ? "eq(N," : "+eq(N,") + std::to_string(k) + ")*" + std::to_string(kStarts[k]);
  }
  make(scratch, from_raw({32, 16, 1}, "gray") + "-vf \"settb=1/1000,setpts='" + times +
                    "'\" -vsync vfr -enc_time_base 1:1000 " + codec + " " + output);
}

TEST(VideoClip, TakesIrregularTimesFromTheContainer) {
  NEEDS_FFMPEG();
  for (const auto& [output, codec] :
       {std::pair<std::string, std::string>{"clip.mkv", "-c:v ffv1 -pix_fmt gray"},
        {"clip.mp4", "-c:v libx264 -bf 2 -pix_fmt yuv420p10le -video_track_timescale 1000"},
        {"eight.mp4", "-c:v libx264 -bf 2 -pix_fmt yuv420p -video_track_timescale 90000"}}) {
    SCOPED_TRACE(output);
    const Scratch scratch;
    make_irregular(scratch, output, codec);
    const auto clip = open_test_clip(scratch / output);
    ASSERT_FALSE(clip->info().timing.rate);
    ASSERT_EQ(clip->info().sample_count, kStarts.size());
    EXPECT_EQ(read_all(*clip).size(), kStarts.size());
    const Timeline timeline = timeline_of(output, clip->info(), {}, {180, 1}, kStarts.size());
    for (std::size_t k = 0; k < kStarts.size(); ++k) {
      EXPECT_EQ(timeline.start_ns(k), kStarts[k] * 1'000'000);
      const std::int64_t period = k + 1 < kStarts.size() ? kStarts[k + 1] - kStarts[k] : 240;
      EXPECT_EQ(timeline.end_ns(k), kStarts[k] * 1'000'000 + period * 500'000);
    }
    EXPECT_EQ(timeline.duration_ns(), 730'000'000);
    // A stated rate goes before them.
    ClipOptions stated;
    stated.rate = Rational{100, 1};
    EXPECT_TRUE(timeline_of(output, clip->info(), stated, {360, 1}, kStarts.size()).is_constant());
  }
}

TEST(VideoClip, RefusesTimesThatDoNotIncrease) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make_irregular(scratch, "clip.mkv", "-c:v ffv1 -pix_fmt gray");
  // A block's header: track 1, then the time after the cluster's in 16 bits.
  std::string bytes = test::read_file(scratch / "clip.mkv");
  const auto at = bytes.find(std::string("\x81\x00\xFA", 3));  // 250 ms
  ASSERT_NE(at, std::string::npos);
  bytes[at + 2] = '\xF0';  // 240 ms, as the picture before
  const auto clip = scratch.write("same.mkv", bytes);
  expect_refused(
      clip, {},
      "same.mkv: sample 5 starts at 240000000 ns, not after sample 4 at 240000000 ns; if they "
      "were taken at a constant rate, state it with --fps");
  ClipOptions stated;
  stated.rate = Rational{25, 1};
  EXPECT_TRUE(
      timeline_of("", open_test_clip(clip, stated)->info(), stated, {360, 1}, 7).is_constant());
}

TEST(VideoClip, RefusesPicturesThatTheDecoderMarksAsDamaged) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch,
       "-f lavfi -i testsrc2=s=64x48:r=25:d=0.6 -c:v libx264 -pix_fmt yuv422p10le clip.mp4");
  const std::string whole = test::read_file(scratch / "clip.mp4");
  int refused = 0;
  for (std::size_t percent = 20; percent < 80; percent += 4) {  // wherever a decoder can see it
    std::string bytes = whole;
    for (std::size_t i = 0; i < 40; ++i) bytes[bytes.size() * percent / 100 + i] ^= 0x5A;
    try {
      const auto rasters = read_all(*open_test_clip(scratch.write("damaged.mp4", bytes)));
    } catch (const InputError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("damaged.mp4"), std::string::npos) << error.what();
    }
  }
  EXPECT_GE(refused, 5);
  std::printf("  %d of 15 damaged files refused\n", refused);
}

// Camera files, against bytes picked out of them by hand.
TEST(VideoClip, GivesTheCodesThatCineFilesHold) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "cine_781.cine")) GTEST_SKIP() << "no clips in " << media;
  const std::string file = test::read_file(media / "cine_781.cine");
  const auto u32 = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, 4);
    return value;
  };
  const auto clip = open_test_clip(media / "cine_781.cine");
  EXPECT_EQ(clip->info().format.shape, (Shape{256, 256, 1}));
  EXPECT_EQ(clip->info().format.white_code, 4095u);
  EXPECT_EQ(clip->info().format.transfer, Transfer::linear());
  // Every tenth picture of nominally 90 000 a second.
  const Timeline timeline = timeline_of("", clip->info(), {}, {360, 1}, 15);
  EXPECT_NEAR(timeline.rate().value(), 9003.21, 0.01);
  EXPECT_NEAR(static_cast<double>(timeline.start_ns(14)), 14 * 111'071.36, 10);
  const auto rasters = read_all(*clip);
  ASSERT_EQ(rasters.size(), 15u);
  for (std::size_t k = 0; k < 15; ++k) {
    const std::size_t image = u32(u32(32) + 8 * k);
    Picture want({256, 256, 1}, ValueType::code16, 4095);
    for (std::size_t y = 0; y < 256; ++y) {
      std::memcpy(want.bytes.data() + y * 512, file.data() + image + u32(image) + y * 512, 512);
    }
    EXPECT_EQ(difference(rasters[k], want), "") << k;
  }

  const auto packed = open_test_clip(media / "data_small_cine.cine");
  EXPECT_EQ(packed->info().format.white_code, 1023u);
  EXPECT_EQ(packed->info().timing.rate, (Rational{100, 1}))
      << "its last picture is stamped 292 days late";
  EXPECT_EQ(packed->info().notes.size(), 2u);
}

}  // namespace
}  // namespace nutik
