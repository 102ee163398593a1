// 8-bit colour video: the codes that OpenCV's reader gives, and those of the matrix that a file names.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cstdlib>

#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik {
namespace {

using test::Scratch;

// Every picture of a clip, code for code.
void expect_as_opencv(const std::filesystem::path& path) {
  SCOPED_TRACE(path.filename());
  const auto rasters = test::read_all(*test::open_test_clip(path));
  cv::VideoCapture capture(path.string(), cv::CAP_FFMPEG);
  ASSERT_TRUE(capture.isOpened());
  cv::Mat bgr, rgb;
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    ASSERT_TRUE(capture.read(bgr)) << k;
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    ASSERT_EQ(rasters[k].size(), rgb.total() * 3) << k;
    ASSERT_TRUE(
        std::equal(rasters[k].begin(), rasters[k].end(), reinterpret_cast<const std::byte*>(rgb.data)))
        << k;
  }
  EXPECT_FALSE(capture.read(bgr));
}

TEST(ColourVideo, HasTheCodesOfOpenCv) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const Shape shapes[] = {{16, 8, 3}, {17, 9, 3}, {30, 30, 3}, {101, 7, 3}, {640, 34, 3}};
  for (const Shape& shape : shapes) {
    scratch.write("raw", test::bytes_of(test::random_stills(shape, 255, 5, 7)));
    for (const char* pixels : {"yuv420p", "yuv422p", "yuv444p", "yuvj420p", "bgr0"}) {
      test::make(scratch, test::from_raw(shape, "rgb24") + "-c:v ffv1 -pix_fmt " + pixels + " clip.mkv");
      expect_as_opencv(scratch / "clip.mkv");
    }
  }
}

TEST(ColourVideo, HasTheCodesOfOpenCvInRealClips) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "bikes.mp4")) GTEST_SKIP() << "no clips in " << media;
  for (const char* name : {"bicycle-wheel.mp4", "realshort.mp4", "bulk-water.mov", "bikes.mp4"}) {
    expect_as_opencv(media / name);
  }
}

// Everyday cameras name BT.709's curve whatever theirs is.
TEST(ColourVideo, IsShownWithTheCurveOfSrgb) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch, "-f lavfi -i color=red:s=16x16:d=0.2 -c:v ffv1 -pix_fmt yuv420p -color_trc bt709 clip.mkv");
  EXPECT_EQ(test::open_test_clip(scratch / "clip.mkv")->info().format.transfer, Transfer::srgb());
}

// Saturated colours, for which BT.601 and BT.709 are up to 29 codes apart.
TEST(ColourVideo, FollowsTheMatrixThatTheFileNames) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  const Shape shape{32, 16, 3};
  constexpr int kColours[][3] = {{200, 30, 30}, {30, 200, 30}, {30, 30, 200}, {128, 128, 128}};
  constexpr int kRounding = 3;  // of Y, U and V to codes, times what they weigh (at most 2.1), and back
  for (const auto& colour : kColours) {
    std::string raw;
    for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
      for (const int code : colour) raw += static_cast<char>(code);
    }
    scratch.write("raw", raw);
    for (const char* matrix : {"bt709", "bt601"}) {
      const std::string tag = matrix == std::string("bt709") ? "bt709" : "smpte170m";
      test::make(scratch, test::from_raw(shape, "rgb24") + "-vf scale=out_color_matrix=" + matrix +
                              ",format=yuv420p -c:v ffv1 -colorspace " + tag + " clip.mkv");
      const auto codes = test::read_all(*test::open_test_clip(scratch / "clip.mkv")).at(0);
      for (std::size_t i = 0; i < codes.size(); ++i) {
        ASSERT_LE(std::abs(std::to_integer<int>(codes[i]) - colour[i % 3]), kRounding) << matrix << ", " << i;
      }
    }
  }
}

}  // namespace
}  // namespace nutik
