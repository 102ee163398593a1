// 8-bit colour video: the codes of the matrix and range that a file names, near those that OpenCV's reader gives.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <tuple>

#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

// Where the luma and chroma of pixel (x, y) lie in a picture of `shape`, in bytes.
struct YuvPlaces {
  std::size_t luma, u, v;
};

struct YuvKind {
  const char* name;
  std::uint32_t across, down;  // pixels that share a chroma sample
  // From the number of pixels of the picture, of its rows and of chroma samples in a row and in all.
  YuvPlaces (*places)(const Shape& shape, std::size_t x, std::size_t y, std::size_t chroma_width,
                      std::size_t chroma_count);
  std::size_t bytes_of_chroma = 2;
};

template <std::size_t kAcross, std::size_t kDown>
YuvPlaces planar(const Shape& shape, std::size_t x, std::size_t y, std::size_t chroma_width,
                 std::size_t count) {
  const std::size_t at = shape.pixel_count() + y / kDown * chroma_width + x / kAcross;
  return {y * shape.width + x, at, at + count};
}
YuvPlaces nv12(const Shape& shape, std::size_t x, std::size_t y, std::size_t chroma_width, std::size_t) {
  const std::size_t at = shape.pixel_count() + 2 * (y / 2 * chroma_width + x / 2);
  return {y * shape.width + x, at, at + 1};
}
YuvPlaces yuyv(const Shape& shape, std::size_t x, std::size_t y, std::size_t, std::size_t) {
  const std::size_t pair = 2 * (y * shape.width + x / 2 * 2);
  return {pair + x % 2 * 2, pair + 1, pair + 3};
}
YuvPlaces uyvy(const Shape& shape, std::size_t x, std::size_t y, std::size_t, std::size_t) {
  const std::size_t pair = 2 * (y * shape.width + x / 2 * 2);
  return {pair + 1 + x % 2 * 2, pair, pair + 2};
}

constexpr YuvKind kYuvKinds[] = {{"yuv420p", 2, 2, planar<2, 2>},
                                 {"yuv422p", 2, 1, planar<2, 1>},
                                 {"yuv444p", 1, 1, planar<1, 1>},
                                 {"yuv440p", 1, 2, planar<1, 2>},
                                 {"yuv411p", 4, 1, planar<4, 1>},
                                 {"yuv410p", 4, 4, planar<4, 4>},
                                 {"nv12", 2, 2, nv12},
                                 {"yuyv422", 2, 1, yuyv},
                                 {"uyvy422", 2, 1, uyvy}};

// Every code of YUV, of every kind of pixels, against the matrix in real numbers. A pixel's chroma is that of the
// sample which it shares.
TEST(ColourVideo, HasTheNearestCodesThatThereAre) {
  Random random(4);
  double worst = 0;
  for (const YuvKind& kind : kYuvKinds) {
    for (const Shape shape : {Shape{4, 4, 3}, Shape{20, 12, 3}, Shape{100, 8, 3}, Shape{128, 36, 3}}) {
      const std::size_t chroma_width = (shape.width + kind.across - 1) / kind.across;
      const std::size_t chroma_count = chroma_width * ((shape.height + kind.down - 1) / kind.down);
      std::string raw(shape.pixel_count() + 2 * chroma_count, '\0');
      for (char& code : raw) code = static_cast<char>(random.whole(0, 255));
      const Scratch scratch;
      scratch.write("raw", raw);
      for (const auto& [matrix, red, blue] : {std::tuple{YuvMatrix::bt601, 0.299, 0.114},
                                              {YuvMatrix::bt709, 0.2126, 0.0722},
                                              {YuvMatrix::bt2020, 0.2627, 0.0593}}) {
        for (const CodeRange range : {CodeRange::limited, CodeRange::full}) {
          const ClipOptions options{.rate = Rational{25, 1},
                                    .raw = RawVideo{shape.width, shape.height, kind.name},
                                    .matrix = matrix,
                                    .range = range};
          const auto codes = read_all(*open_test_clip(scratch / "raw", options)).at(0);
          const bool is_full = range == CodeRange::full;
          const auto byte = [&](std::size_t at) { return double(static_cast<unsigned char>(raw[at])); };
          for (std::size_t y = 0; y < shape.height; ++y) {
            for (std::size_t x = 0; x < shape.width; ++x) {
              const YuvPlaces at = kind.places(shape, x, y, chroma_width, chroma_count);
              const double luma = is_full ? byte(at.luma) : (byte(at.luma) - 16) * 255 / 219;
              const double chroma = is_full ? 1.0 : 255.0 / 224;
              const double u = (byte(at.u) - 128) * chroma, v = (byte(at.v) - 128) * chroma;
              const double r = luma + 2 * (1 - red) * v, b = luma + 2 * (1 - blue) * u;
              const double g = (luma - red * r - blue * b) / (1 - red - blue);
              const double exact[] = {r, g, b};
              for (std::size_t channel = 0; channel < 3; ++channel) {
                const double want = std::clamp(exact[channel], 0.0, 255.0);
                const double got = std::to_integer<int>(codes[(y * shape.width + x) * 3 + channel]);
                worst = std::max(worst, std::abs(got - want));
                ASSERT_LE(std::abs(got - want), 0.53)
                    << kind.name << " " << x << "," << y << ", channel " << channel;
              }
            }
          }
        }
      }
    }
  }
  std::printf("worst distance from the matrix: %.3f codes\n", worst);
}

// Every picture of a clip, in its order. OpenCV cuts off luma, and what both chromas add to green, by up to 3 codes.
void expect_near_opencv(const std::filesystem::path& path, int apart) {
  SCOPED_TRACE(path.filename());
  const auto rasters = read_all(*open_test_clip(path));
  cv::VideoCapture capture(path.string(), cv::CAP_FFMPEG);
  ASSERT_TRUE(capture.isOpened());
  cv::Mat bgr, rgb;
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    ASSERT_TRUE(capture.read(bgr)) << k;
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    ASSERT_EQ(rasters[k].size(), rgb.total() * 3) << k;
    int worst = 0;
    for (std::size_t i = 0; i < rasters[k].size(); ++i)
      worst = std::max(worst, std::abs(std::to_integer<int>(rasters[k][i]) - rgb.data[i]));
    ASSERT_LE(worst, apart) << k;
  }
  EXPECT_FALSE(capture.read(bgr));
}

TEST(ColourVideo, OfRgbHasTheCodesOfOpenCv) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const Shape& shape : {Shape{16, 8, 3}, Shape{17, 9, 3}, Shape{101, 7, 3}, Shape{640, 34, 3}}) {
    scratch.write("raw", bytes_of(random_stills(shape, 255, 5, 7)));
    test::make(scratch, from_raw(shape, "rgb24") + "-c:v ffv1 -pix_fmt bgr0 clip.mkv");
    expect_near_opencv(scratch / "clip.mkv", 0);
  }
}

TEST(ColourVideo, IsNearTheCodesOfOpenCvInRealClips) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "bikes.mp4")) GTEST_SKIP() << "no clips in " << media;
  for (const char* name : {"bicycle-wheel.mp4", "realshort.mp4", "bulk-water.mov", "bikes.mp4"}) {
    expect_near_opencv(media / name, 3);
  }
}

// Everyday cameras name BT.709's curve whatever theirs is.
TEST(ColourVideo, IsShownWithTheCurveOfSrgb) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  test::make(scratch,
             "-f lavfi -i color=red:s=16x16:d=0.2 -c:v ffv1 -pix_fmt yuv420p -color_trc bt709 clip.mkv");
  const auto clip = open_test_clip(scratch / "clip.mkv");
  EXPECT_EQ(clip->info().format.transfer, Transfer::srgb());
  EXPECT_EQ(clip->info().roundings, (CodeRoundings{0.525, {"chroma"}})) << "of its RGB";
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
      test::make(scratch, from_raw(shape, "rgb24") + "-vf scale=out_color_matrix=" + matrix +
                              ",format=yuv420p -c:v ffv1 -colorspace " + tag + " clip.mkv");
      const auto codes = read_all(*open_test_clip(scratch / "clip.mkv")).at(0);
      for (std::size_t i = 0; i < codes.size(); ++i) {
        ASSERT_LE(std::abs(std::to_integer<int>(codes[i]) - colour[i % 3]), kRounding) << matrix << ", " << i;
      }
    }
  }
}

}  // namespace
}  // namespace nutik::test
