// Videos that were written give their frames back, at their rate.
#include "media/writers/video_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

VideoFormat format_of(const Picture& picture, Rational rate) {
  return {picture.shape, picture.type, picture.white_code, Transfer::srgb(), rate};
}

void write_video(const std::filesystem::path& path, const std::vector<Picture>& pictures, Rational rate,
                 const std::optional<std::string>& codec = std::nullopt) {
  use_modules();
  const auto writer =
      open_video_writer(path, format_of(pictures.front(), rate), video_codec_for(path, codec));
  for (const Picture& picture : pictures) writer->write(picture);
  writer->finish();
}

std::size_t file_count(const Scratch& scratch) {
  const std::filesystem::directory_iterator files(scratch.folder());
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

// The one that readers take for so many lines, those too that ignore what a file names; a JPEG always has BT.601's. By
// another the red of these frames would be 13 codes off.
TEST(VideoWriter, NamesAndUsesTheMatrixThatIsUsualForItsLines) {
  for (const auto& [name, codec, lines, said] :
       {std::tuple("v.mov", "prores", 720u, "matrix bt709, from the file"),
        {"v.mkv", "prores", 720u, "matrix bt709, from the file"},
        {"v.mp4", "h264", 720u, "matrix bt709, from the file"},
        {"v.mp4", "h264", 719u, "matrix bt709, from the file"},  // written as 720
        {"v.mp4", "h264", 718u, "matrix bt601, from the file"},
        {"v.mp4", "h265", 720u, "matrix bt709, from the file"},
        {"v.webm", "vp9", 720u, "matrix bt709, from the file"},
        {"v.webm", "vp9", 480u, "matrix bt601, from the file"},
        {"v.mov", "prores", 480u, "matrix bt601, from the file"},
        {"v.mov", "mjpeg", 720u, "matrix bt601, from the file"},
        {"v.avi", "mjpeg", 720u, "matrix bt601, from the file"}}) {
    SCOPED_TRACE(format("{}, {}, {} lines", name, codec, lines));
    const Scratch scratch;
    const bool is_deep = !video_codec_for(name, codec).holds_8_bits;
    Picture picture({32, lines, 3}, is_deep ? ValueType::code16 : ValueType::code8, is_deep ? 65'535 : 255);
    constexpr int kRed[] = {200, 40, 60};
    for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
      if (is_deep) picture.values<std::uint16_t>()[i] = static_cast<std::uint16_t>(kRed[i % 3] * 257);
      if (!is_deep) picture.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(kRed[i % 3]);
    }
    write_video(scratch / name, {picture, picture}, {25, 1}, codec);
    const auto clip = open_test_clip(scratch / name);
    const auto matrix = std::ranges::find(clip->info().facts, Setting::matrix, &Fact::setting);
    ASSERT_NE(matrix, clip->info().facts.end());
    EXPECT_EQ(matrix->line(), said);
    const auto raster = read_all(*clip).front();
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint16_t deep = 0;
      if (is_deep) std::memcpy(&deep, &raster[2 * i], 2);
      EXPECT_NEAR(is_deep ? deep / 257.0 : std::to_integer<int>(raster[i]), kRed[i], 4) << i;
    }
  }
}

TEST(VideoWriter, Ffv1GivesEveryCodeBack) {
  for (const char* name : {"v.mkv", "v.avi"}) {
    for (const std::uint32_t channels : {1u, 3u}) {
      for (const std::uint32_t white : {255u, 65'535u}) {
        for (const auto& [width, height] : {std::pair{17u, 9u}, {64u, 48u}, {1u, 9u}, {33u, 1u}, {2u, 2u}}) {
          SCOPED_TRACE(std::string(name) + ", " + std::to_string(channels) + " channels, white " +
                       std::to_string(white) + ", width " + std::to_string(width));
          const Scratch scratch;
          const auto pictures = random_stills({width, height, channels}, white, 5, width + white);
          write_video(scratch / name, pictures, {30000, 1001});
          EXPECT_EQ(file_count(scratch), 1u);  // no temporary file stays
          const auto clip = open_test_clip(scratch / name);
          EXPECT_EQ(clip->info().format.shape, pictures[0].shape);
          EXPECT_EQ(clip->info().format.white_code, white);
          EXPECT_EQ(clip->info().timing.rate, (Rational{30000, 1001}));
          const auto rasters = read_all(*clip);
          ASSERT_EQ(rasters.size(), pictures.size());
          for (std::size_t k = 0; k < rasters.size(); ++k) {
            EXPECT_EQ(difference(rasters[k], pictures[k]), "") << k;
          }
        }
      }
    }
  }
}

// Every frame of one colour: what a wrong matrix or range would move by more than 15 codes. Rounding to YUV of
// 8 bits and back moves a code by 2 at most, quantization at this quality by no more than that again.
TEST(VideoWriter, EveryCodecKeepsTheColours) {
  const std::pair<const char*, const char*> files[] = {
      {"v.mp4", "h264"},  {"v.mov", "h265"}, {"v.webm", "vp9"}, {"v.mov", "prores"},
      {"v.avi", "mjpeg"}, {"v.m4v", "h264"}, {"v.mkv", "vp9"}};
  for (const auto& [name, codec_name] : files) {
    SCOPED_TRACE(std::string(codec_name) + " in " + name);
    const Scratch scratch;
    const bool deep = !video_codec_for(name, codec_name).holds_8_bits;
    const std::uint8_t colours[][3] = {
        {200, 40, 60}, {30, 180, 90}, {20, 60, 220}, {255, 255, 255}, {0, 0, 0}};
    std::vector<Picture> pictures;
    for (const auto& colour : colours) {
      Picture picture({64, 64, 3}, deep ? ValueType::code16 : ValueType::code8, deep ? 65'535 : 255);
      for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
        if (deep) {
          picture.values<std::uint16_t>()[i] = static_cast<std::uint16_t>(colour[i % 3] * 257);
        } else {
          picture.values<std::uint8_t>()[i] = colour[i % 3];
        }
      }
      pictures.push_back(std::move(picture));
    }
    write_video(scratch / name, pictures, {25, 1}, codec_name);
    const auto clip = open_test_clip(scratch / name);
    EXPECT_EQ(clip->info().timing.rate, (Rational{25, 1}));
    const auto rasters = read_all(*clip);
    ASSERT_EQ(rasters.size(), pictures.size());
    const bool reads_deep = clip->info().format.code_bytes == 2;
    int worst = 0;
    for (std::size_t k = 0; k < rasters.size(); ++k) {
      for (std::size_t i = 0; i < 64 * 64 * 3; ++i) {
        const int code = reads_deep ? reinterpret_cast<const std::uint16_t*>(rasters[k].data())[i] / 257
                                    : static_cast<int>(rasters[k][i]);
        worst = std::max(worst, std::abs(code - colours[k][i % 3]));
      }
    }
    EXPECT_LE(worst, 4);
    RecordProperty(std::string("worst_") + codec_name, worst);
  }
}

// A grey of ten bits is the nearest code of the limited range, not one of 255/256 of it.
TEST(VideoWriter, DeepFilmsAreAsBrightAsTheirFrames) {
  use_modules();
  for (const auto& [name, codec_name] :
       {std::pair("v.mov", "prores-4444"), {"v.mov", "dnxhr-444"}, {"v.mp4", "h264-10"}}) {
    for (const std::uint16_t grey : std::array<std::uint16_t, 3>{2'000, 32'768, 60'000}) {
      for (const std::uint32_t channels : {1u, 3u}) {
        const Scratch scratch;
        Picture picture({256, 128, channels}, ValueType::code16, 65'535);
        std::ranges::fill(picture.values<std::uint16_t>(), grey);
        write_video(scratch / name, {picture}, {25, 1}, codec_name);
        const auto raster = read_all(*open_test_clip(scratch / name)).front();
        const int code = reinterpret_cast<const std::uint16_t*>(raster.data())[3 * (64 * 256 + 128)];
        EXPECT_NEAR(code, grey, 65'535.0 / 876 / 2 + 1) << codec_name << " " << channels;
      }
    }
  }
}

TEST(VideoWriter, SaysWhatAnEncoderDoesNotTake) {
  use_modules();
  const Scratch scratch;
  const Picture small({64, 48, 3}, ValueType::code16, 65'535);
  EXPECT_THROW(static_cast<void>(video_codec_for("v.m4v", "h265")), UsageError);  // FFmpeg's muxer knows no tag for it
  EXPECT_THROW(static_cast<void>(video_codec_for("v-%03d.webp", {})), UsageError);
  try {
    write_video(scratch / "v.mov", {small}, {25, 1}, "dnxhr-hqx");
    FAIL();
  } catch (const OutputError& error) {
    const std::string_view said = error.what();
    expect_says(said, "takes no frames of 64 x 48 at 25 a second: 256 x 120 is its smallest");
  }
}

// All but WebM have a place for the shape of pixels.
TEST(VideoWriter, KeepsPixelsThatAreNotSquareOrSaysWhatBecomesOfThem) {
  use_modules();
  for (const auto& [name, width, aspect, kept] :
       {std::tuple("v.mp4", 64u, Rational{32, 27}, Rational{32, 27}),
        {"v.mov", 64u, {32, 27}, {32, 27}},
        {"v.mkv", 64u, {32, 27}, {32, 27}},
        {"v.avi", 64u, {32, 27}, {32, 27}},
        {"v.webm", 54u, {32, 27}, {32, 27}},
        {"v.webm", 64u, {32, 27}, {19, 16}},  // 75.85 columns
        {"v.webm", 64u, {10, 11}, {29, 32}},
        {"v.webm", 64u, {200, 199}, {1, 1}}}) {
    SCOPED_TRACE(name + std::string(" ") + std::to_string(width));
    const Scratch scratch;
    const Picture picture = random_stills({width, 48, 3}, 255, 1, 5).front();
    VideoFormat format = format_of(picture, {25, 1});
    format.pixel_aspect = aspect;
    const auto writer = open_video_writer(scratch / name, format, video_codec_for(scratch / name, {}));
    writer->write(picture);
    writer->finish();
    EXPECT_EQ(open_test_clip(scratch / name)->info().format.pixel_aspect, kept);
    const auto notes = writer->notes();
    ASSERT_EQ(notes.size(), kept == aspect ? 0u : 1u);
    if (aspect == Rational{10, 11}) {
      EXPECT_EQ(
          notes[0],
          "a .webm tells players a size in whole pixels, 58 x 48 for frames of 64 x 48: pixels are shown "
          "29:32 in the place of 10:11; other containers keep that");
    }
  }
}

TEST(VideoWriter, RepeatsTheLastRowAndColumnOfOddSizes) {
  const Scratch scratch;
  use_modules();
  Picture picture({65, 33, 3}, ValueType::code8, 255);
  for (auto& code : picture.values<std::uint8_t>()) code = 90;
  const auto writer = open_video_writer(scratch / "v.mp4", format_of(picture, {24, 1}),
                                        video_codec_for("v.mp4", std::nullopt));
  ASSERT_EQ(writer->notes().size(), 1u);
  expect_says(writer->notes()[0], "65 x 33 became 66 x 34");
  for (int k = 0; k < 3; ++k) writer->write(picture);
  writer->finish();
  const auto clip = open_test_clip(scratch / "v.mp4");
  EXPECT_EQ(clip->info().format.shape, (Shape{66, 34, 3}));
  for (const auto& raster : read_all(*clip)) {
    for (const std::byte code : raster) ASSERT_NEAR(static_cast<int>(code), 90, 2);
  }
}

TEST(VideoWriter, LeavesNothingOfAVideoThatIsNotFinished) {
  const Scratch scratch;
  use_modules();
  const auto pictures = random_stills({32, 32, 3}, 255, 2, 1);
  {
    const auto writer = open_video_writer(scratch / "v.mkv", format_of(pictures[0], {24, 1}),
                                          video_codec_for("v.mkv", std::nullopt));
    writer->write(pictures[0]);
    EXPECT_EQ(file_count(scratch), 1u);  // the temporary file
    EXPECT_FALSE(std::filesystem::exists(scratch / "v.mkv"));
  }
  EXPECT_EQ(file_count(scratch), 0u);
}

TEST(VideoWriter, RefusesWhatAContainerOrCodecCannotHold) {
  const auto codec = [](const char* path, const char* name) {
    return message_of<Error>([&] { return video_codec_for(path, name); });
  };
  EXPECT_EQ(codec("v.mp4", "ffv1"), "v.mp4: a .mp4 file holds h264, h264-10, h265, h265-10, av1, av1-10, not ffv1");
  EXPECT_EQ(
      codec("v.mkv", "h263"),
      "video codec 'h263' is not known; choose one of: ffv1, h264, h264-10, h265, h265-10, av1, av1-10, vp9, "
      "prores, prores-proxy, prores-lt, prores-422, prores-4444, dnxhr-lb, dnxhr-sq, dnxhr-hq, dnxhr-hqx, dnxhr-444, "
      "mjpeg, gif, webp");
  expect_says(codec("v.ogg", "ffv1"), "videos are written as .mp4");
  EXPECT_EQ(video_codec_for("a/V.MKV", std::nullopt).name, "ffv1");
  const auto type = [](const char* path, std::optional<Depth> wish) {
    return message_of<Error>(
        [&] { return video_value_type(video_codec_for(path, std::nullopt), wish, ValueType::code8); });
  };
  expect_says(type("v.mp4", Depth::bits16), "for 16 use ffv1");
  expect_says(type("v.mkv", Depth::floating), "write numbered stills");
  EXPECT_EQ(type("v.mkv", Depth::bits16), "");
  // A deep capture gives way to what the codec holds.
  EXPECT_EQ(video_value_type(video_codec_for("v.mp4", std::nullopt), std::nullopt, ValueType::code16),
            ValueType::code8);
}

TEST(VideoWriter, SaysWhatCannotBeWritten) {
  use_modules();
  const auto pictures = random_stills({32, 32, 3}, 255, 1, 1);
  const std::string message = message_of<Error>([&] {
    const auto writer = open_video_writer("/nowhere/v.mkv", format_of(pictures[0], {24, 1}),
                                          video_codec_for("v.mkv", std::nullopt));
  });
  EXPECT_EQ(message, "/nowhere/v.mkv cannot be created: there is no folder /nowhere");
}

}  // namespace
}  // namespace nutik::test
