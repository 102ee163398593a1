#include "media/motion/registration.hpp"

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace nutik::motion {
namespace {

constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 21;  // of the finest level: 1080p as it is
constexpr int kMinSide = 24;
// So that a cubic between pixels goes through what it is fitted to, and noise counts less.
constexpr double kBlurPixels = 1.0;
constexpr int kFeatureSide = 480;

template <typename Code>
void write_grey(const CaptureFormat& format, const Code* codes, cv::Mat& grey) {
  const auto [width, height, channels] = format.shape;
  const auto scale = static_cast<float>(kGreyWhite / format.white_code);
  grey.create(static_cast<int>(height), static_cast<int>(width), CV_32F);
  for (int y = 0; y < grey.rows; ++y) {
    auto* const row = grey.ptr<float>(y);
    for (int x = 0; x < grey.cols; ++x, codes += channels) {
      row[x] = scale * (channels == 1 ? static_cast<float>(codes[0])
                                      : static_cast<float>(kLuma[0]) * static_cast<float>(codes[0]) +
                                            static_cast<float>(kLuma[1]) * static_cast<float>(codes[1]) +
                                            static_cast<float>(kLuma[2]) * static_cast<float>(codes[2]));
    }
  }
}

}  // namespace

void GreyPyramid::take(const CaptureFormat& format, std::span<const std::byte> raster) {
  std::size_t smallest = 0;
  const auto grey_at = [&](std::size_t size) -> cv::Mat& {
    if (size == greys_.size()) greys_.emplace_back();
    return greys_[size];
  };
  const auto halve = [&] {
    cv::Mat& half = grey_at(smallest + 1);
    cv::pyrDown(greys_[smallest++], half);
  };
  format.code_bytes == 1
      ? write_grey(format, reinterpret_cast<const std::uint8_t*>(raster.data()), grey_at(0))
      : write_grey(format, reinterpret_cast<const std::uint16_t*>(raster.data()), grey_at(0));
  while (greys_[smallest].total() > kMaxPixels) halve();
  finest = static_cast<int>(smallest);
  for (std::size_t level = 0;; ++level) {
    const cv::Mat& grey = greys_[smallest];
    if (level == levels.size()) levels.emplace_back();
    cv::GaussianBlur(grey, levels[level], {}, kBlurPixels);
    if (std::min(grey.cols, grey.rows) < 2 * kMinSide) return;
    halve();
  }
}

double GreyPyramid::feature_scale() const {
  std::size_t level = 0;
  while (level + 1 < levels.size() && std::max(levels[level].cols, levels[level].rows) > kFeatureSide)
    ++level;
  return std::ldexp(1.0, finest + static_cast<int>(level));
}

cv::Mat GreyPyramid::of_features() const {
  const auto level = static_cast<std::size_t>(std::ilogb(feature_scale()) - finest);
  cv::Mat bytes;
  levels[level].convertTo(bytes, CV_8U);
  return bytes;
}

}  // namespace nutik::motion
