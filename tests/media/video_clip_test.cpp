// Video whose depth OpenCV's reader would lose: codes, white and transfer.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "capture/error.hpp"
#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kGrey{17, 9, 1}, kColour{17, 9, 3};

std::string with_bytes_swapped(std::string bytes) {
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  return bytes;
}

ClipOptions raw_options(Shape shape, const std::string& pixels) {
  return {.rate = Rational{25, 1}, .raw = RawVideo{shape.width, shape.height, pixels}};
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
    const auto pictures = random_stills(kGrey, white, 4, white);
    scratch.write("raw", bytes_of(pictures));
    make(scratch, from_raw(kGrey, pixels) + "-c:v ffv1 -pix_fmt " + pixels + " clip.mkv");
    const auto clip = open_test_clip(scratch / "clip.mkv");
    EXPECT_EQ(clip->info().format.white_code, white);
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
    const auto pictures = random_stills(kind.shape, kind.white, 3, kind.white);
    std::string bytes = bytes_of(pictures);
    if (kind.swapped) bytes = with_bytes_swapped(bytes);
    const auto clip = open_test_clip(scratch.write("raw", bytes), raw_options(kind.shape, kind.pixels));
    EXPECT_EQ(clip->info().format.white_code, kind.white);
    expect_codes(*clip, pictures);
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
  const Picture planes = random_stills({17, 27, 1}, 1023, 1, 4)[0];
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
    Random random(5);
    std::vector<Picture> planes{Picture({17, 27, 1}, ValueType::code16, 1023)};
    const std::size_t count = kGrey.pixel_count();
    auto codes = planes[0].values<std::uint16_t>();
    for (std::size_t i = 0; i < 3 * count; ++i) {
      // Colours near grey, so that hardly any lies outside RGB.
      codes[i] = static_cast<std::uint16_t>(i < count ? random.whole(200, 800) : random.whole(452, 572));
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
      const double green = (y - colours.red * red - colours.blue * blue) / (1 - colours.red - colours.blue);
      const double want[] = {red, green, blue};
      for (std::size_t channel = 0; channel < 3; ++channel) {
        worst =
            std::max(worst, std::abs(rgb[i * 3 + channel] - 65'535 * std::clamp(want[channel], 0.0, 1.0)));
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
  expect_clip_refused(file, raw_options(kGrey, "grayf32le"), "holds floating-point pixels (grayf32le)");
  expect_clip_refused(file, raw_options({17, 8, 1}, "gray"),
                      "612 bytes, which is no whole number of pictures of 136 bytes (17 x 8, gray); check "
                      "its size and pixel format");
  expect_clip_refused(file, raw_options(kGrey, "grey"), "'grey' is no pixel format that FFmpeg knows");
  expect_clip_refused(scratch.write("empty", ""), raw_options(kGrey, "gray"), "is empty");
  ClipOptions without_rate = raw_options(kGrey, "gray");
  without_rate.rate.reset();
  expect_clip_refused(file, without_rate, "raw does not say how fast it was taken; state the rate");
  ClipOptions with_white = raw_options(kColour, "rgb48le");
  with_white.white_code = 1023;
  expect_clip_refused(
      scratch.write("rgb", std::string(17 * 9 * 6, '\0')), with_white,
      "colour video is converted to RGB, whose white is 65535 whatever its depth was, not 1023");
}

TEST(VideoClip, SaysThatATransferFunctionIsNotKnown) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  scratch.write("raw", bytes_of(random_stills({17, 27, 1}, 1023, 1, 4)));
  for (const auto& [name, known] : {std::pair<std::string, bool>{"bt709", true}, {"smpte428", false}}) {
    make(scratch,
         from_raw(kGrey, "yuv444p10le") + "-c:v ffv1 -pix_fmt yuv444p10le -color_trc " + name + " clip.mkv");
    const auto clip = open_test_clip(scratch / "clip.mkv");
    EXPECT_EQ(clip->info().format.transfer, known ? Transfer::bt709() : Transfer::srgb());
    ASSERT_EQ(clip->info().notes.size(), known ? 0u : 1u);
    if (known) continue;
    expect_says(clip->info().notes[0].text, "transfer function, smpte428, is not known");
  }
}

TEST(VideoClip, StandsUprightAsPlayersShowIt) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  scratch.write("raw", bytes_of(random_stills({16, 8, 1}, 4095, 2, 4)));
  make(scratch, from_raw({16, 8, 1}, "gray12le") + "-c:v ffv1 -pix_fmt gray12le clip.mov");
  for (const int angle : {0, 90, 180, 270}) {
    const double across = angle == 90 ? 1 : angle == 270 ? -1 : 0, along = angle == 0 ? 1 : angle == 180 ? -1 : 0;
    set_display_matrix(scratch / "clip.mov", {along, across, -across, along});
    make(scratch, "-i clip.mov -f rawvideo -pix_fmt gray12le shown");  // ffmpeg turns it, too
    const auto clip = open_test_clip(scratch / "clip.mov");
    const bool swapped = angle % 180 != 0;
    EXPECT_EQ(clip->info().format.shape, (Shape{swapped ? 8u : 16u, swapped ? 16u : 8u, 1}));
    std::string got;
    for (const auto& raster : read_all(*clip))
      got.append(reinterpret_cast<const char*>(raster.data()), raster.size());
    EXPECT_EQ(got, read_file(scratch / "shown")) << angle;
  }
}

// What is between quarter turns is said, and not made.
TEST(VideoClip, SaysWhereItsPicturesAreTurnedByNoQuarter) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=16x8:r=25 -frames:v 2 -c:v ffv1 flat.mov");
  const auto open_with = [&](const std::array<double, 4>& turn) {
    set_display_matrix(scratch / "flat.mov", turn);
    return open_test_clip(scratch / "flat.mov");
  };
  const auto turned = [](double degrees) {
    const double angle = degrees * 3.14159265358979 / 180;
    return std::array{std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)};
  };
  for (const double degrees : {0.0, 90.0, 180.0, 270.0, 0.2})
    EXPECT_TRUE(open_with(turned(degrees))->info().notes.empty()) << degrees;
  EXPECT_TRUE(open_with({-1, 0, 0, 1})->info().notes.empty()) << "a mirror";
  EXPECT_TRUE(open_with({2, 0, 0, 2})->info().notes.empty()) << "twice as large";
  for (const auto& [degrees, made] : {std::pair(15.0, 0), {60.0, 90}, {-20.0, 0}}) {
    const auto clip = open_with(turned(degrees));
    ASSERT_EQ(clip->info().notes.size(), 1u) << degrees;
    EXPECT_EQ(clip->info().notes[0].text,
              "the file's display matrix turns its pictures clockwise by " +
                  std::to_string(static_cast<int>(degrees)) +
                  " degrees, and only quarter turns are made: they are turned by " + std::to_string(made) +
                  " degrees");
    EXPECT_EQ(clip->info().format.shape.width, made == 90 ? 8u : 16u);
  }
  expect_says(open_with({1, 0, 0.5, 1})->info().notes.at(0).text, "skews its pictures");
  const auto senseless = open_with({0, 0, 0, 0});
  ASSERT_EQ(senseless->info().notes.size(), 1u);
  expect_says(senseless->info().notes[0].text, "makes no sense");
}

TEST(VideoClip, RefusesPicturesThatTheDecoderMarksAsDamaged) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  make(scratch, "-f lavfi -i testsrc2=s=64x48:r=25:d=0.6 -c:v libx264 -pix_fmt yuv422p10le clip.mp4");
  const std::string whole = read_file(scratch / "clip.mp4");
  int refused = 0;
  for (std::size_t percent = 20; percent < 80; percent += 4) {  // wherever a decoder can see it
    std::string bytes = whole;
    for (std::size_t i = 0; i < 40; ++i) bytes[bytes.size() * percent / 100 + i] ^= 0x5A;
    const auto path = scratch.write("damaged.mp4", bytes);
    const std::string message = message_of<InputError>([&] { return read_all(*open_test_clip(path)); });
    if (message.empty()) continue;
    ++refused;
    expect_says(message, "damaged.mp4");
  }
  EXPECT_GE(refused, 5);
  std::printf("  %d of 15 damaged files refused\n", refused);
}

}  // namespace
}  // namespace nutik::test
