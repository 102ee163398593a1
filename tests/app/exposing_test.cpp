// Whole paths through the program: clip to capture to picture, and clip to picture.
#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>

#include "capture/transfer.hpp"
#include "support/app_test.hpp"
#include "support/ffmpeg.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// A lossless clip: `count` noisy pictures with a moving square.
void write_clip(const std::filesystem::path& path, int width, int height, int count) {
  std::string raw;
  Random random(7);
  for (int k = 0; k < count; ++k) {
    cv::Mat picture(height, width, CV_8UC3);
    for (int i = 0; i < width * height * 3; ++i) {
      picture.data[i] = static_cast<std::uint8_t>(60 + (i * 7) % 90 + (i % 5 == 0 ? random.whole(0, 9) : 0));
    }
    for (int y = 0; y < std::min(6, height); ++y) {
      for (int x = k; x < std::min(k + 6, width); ++x) picture.at<cv::Vec3b>(y, x) = {250, 240, 10};
    }
    raw.append(reinterpret_cast<const char*>(picture.data), picture.total() * picture.elemSize());
  }
  const Scratch scratch;
  scratch.write("raw", raw);
  const Shape shape{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 3};
  test::make(scratch, from_raw(shape, "bgr24") + "-c:v ffv1 -pix_fmt bgr0 " + path.string());
}

std::vector<cv::Mat> read_clip(const std::filesystem::path& path) {
  cv::VideoCapture capture(path.string());
  std::vector<cv::Mat> pictures;
  for (cv::Mat picture; capture.read(picture);) pictures.push_back(picture.clone());
  return pictures;
}

struct Size {
  int width, height, count;
};

class Exposing : public AppTest, public testing::WithParamInterface<Size> {
 protected:
  ProgramResult run(const Words& words) const { return make(over(words)); }
};

TEST_P(Exposing, OneSampleGivesItsCodesBack) {
  const Size size = GetParam();
  write_clip(scratch_ / "clip.mkv", size.width, size.height, size.count);
  const auto pictures = read_clip(scratch_ / "clip.mkv");
  ASSERT_EQ(pictures.size(), static_cast<std::size_t>(size.count));
  run("-f 100 clip.mkv clip.tik");
  const int sample = size.count / 2;
  const std::string start = std::to_string(sample) + "f";
  for (const std::string source : {"clip.tik", "clip.mkv"}) {
    run({"--start", start, "--exposure", "1f", source, "picture.png", source == "clip.mkv" ? "--fps=100" : "-q"});
    const cv::Mat exposed = picture("picture.png");
    ASSERT_EQ(exposed.size(), pictures[0].size());
    EXPECT_EQ(cv::norm(exposed, pictures[static_cast<std::size_t>(sample)], cv::NORM_INF), 0) << source;
  }
}

TEST_P(Exposing, AClipGivesThePictureOfItsCapture) {
  const Size size = GetParam();
  write_clip(scratch_ / "clip.mkv", size.width, size.height, size.count);
  scratch_.write("f.fn", "M0 [0:0], [20000000:1], [90000000:-0.25], [130000000:0]\n");
  for (const char* tolerance : {"0", "5"}) {
    run({"-a", "180", "--tolerance", tolerance, "clip.mkv", "clip.tik"});
    run("-k f.fn clip.tik a.png --no-recipe");
    run({"-a", "180", "--tolerance", tolerance, "-k", "f.fn", "clip.mkv", "b.png", "--no-recipe"});
    EXPECT_EQ(file("a.png"), file("b.png")) << tolerance;
    run("-k f.fn clip.tik c.png --renderer reference --no-recipe");
    EXPECT_EQ(file("a.png"), file("c.png")) << tolerance;
  }
}

TEST_P(Exposing, EveryFormatHoldsTheSameLight) {
  const Size size = GetParam();
  write_clip(scratch_ / "clip.mkv", size.width, size.height, size.count);
  run("clip.mkv clip.tik");
  scratch_.write("f.fn", "M0 [0:1.5], [70000000:-0.5], [70000001:0]\n");
  run("-k f.fn clip.tik light.pfm");
  run("-k f.fn clip.tik light.tif --depth float");
  run("-k f.fn clip.tik codes.png");
  run("-k f.fn clip.tik deep.png --depth 16");
  const cv::Mat light = picture("light.pfm"), tiff = picture("light.tif");
  const cv::Mat codes = picture("codes.png"), deep = picture("deep.png");
  ASSERT_EQ(light.type(), CV_32FC3);
  ASSERT_EQ(light.size(), cv::Size(size.width, size.height));
  ASSERT_EQ(deep.size(), light.size());
  ASSERT_EQ(codes.size(), light.size());
  ASSERT_EQ(cv::norm(light, tiff, cv::NORM_INF), 0);
  const Transfer srgb = Transfer::srgb();
  for (int i = 0; i < size.width * size.height * 3; ++i) {
    const double value = light.ptr<float>()[i];
    const double fraction = srgb.fraction_of(std::clamp(value, 0.0, 1.0));
    // The float has 24 bits: it may lie on the other side of a rounding edge.
    ASSERT_NEAR(codes.ptr<std::uint8_t>()[i], fraction * 255, 0.5 + 255 * 13 * 0x1p-24);
    ASSERT_NEAR(deep.ptr<std::uint16_t>()[i], fraction * 65535, 0.5 + 65535 * 13 * 0x1p-24);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Exposing,
                         testing::Values(Size{64, 48, 10}, Size{17, 9, 7}, Size{1, 1, 5}, Size{16, 16, 1},
                                         Size{9, 8, 2}, Size{65, 63, 70}),
                         [](const auto& tested) {
                           const Size size = tested.param;
                           return std::to_string(size.width) + "x" + std::to_string(size.height) + "x" +
                                  std::to_string(size.count);
                         });

}  // namespace
}  // namespace nutik::test
