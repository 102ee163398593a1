#include "align/motion/grey_pyramid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "align/registrar.hpp"
#include "system/simd_clones.hpp"

namespace nutik::motion {
namespace {

constexpr int kMinSide = 24;
// So that a cubic between pixels goes through what it is fitted to, and noise counts less.
constexpr double kBlurPixels = 1.0;
constexpr int kFeatureSide = 480;

NUTIK_SIMD_CLONES void add_row(const std::uint8_t* codes, std::size_t count, float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += static_cast<float>(codes[i]);
}

NUTIK_SIMD_CLONES void add_row(const std::uint16_t* codes, std::size_t count, float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += static_cast<float>(codes[i]);
}

template <std::size_t channels, typename Code>
void write_grey(const CaptureFormat& format, const Code* codes, std::uint32_t side, cv::Mat& grey) {
  const std::size_t width = format.shape.width;
  std::array<float, 3> shares{1, 0, 0};
  if (channels > 1) std::ranges::copy(kLuma, shares.begin());
  for (float& share : shares) share *= static_cast<float>(kGreyWhite / side / side / format.white_code);
  grey.create(static_cast<int>(format.shape.height / side), static_cast<int>(width / side), CV_32F);
  std::vector<float> sums(width * channels);
  for (int y = 0; y < grey.rows; ++y) {
    std::ranges::fill(sums, 0.0f);
    for (std::uint32_t row = 0; row < side; ++row, codes += sums.size()) add_row(codes, sums.size(), sums.data());
    auto* const to = grey.ptr<float>(y);
    const float* from = sums.data();
    for (int x = 0; x < grey.cols; ++x) {
      float sum[3] = {};
      for (std::uint32_t column = 0; column < side; ++column, from += channels) {
        for (std::size_t channel = 0; channel < channels; ++channel) sum[channel] += from[channel];
      }
      to[x] = shares[0] * sum[0] + shares[1] * sum[1] + shares[2] * sum[2];
    }
  }
}

}  // namespace

void GreyPyramid::take(const CaptureFormat& format, std::span<const std::byte> raster) {
  finest = registered_halvings(format.shape);
  const std::uint32_t side = 1U << finest;
  with_codes(format.code_bytes, raster.data(), [&](const auto* codes) {
    format.shape.channels == 1 ? write_grey<1>(format, codes, side, greys_[0])
                               : write_grey<3>(format, codes, side, greys_[0]);
  });
  for (std::size_t level = 0;; ++level) {
    const cv::Mat& grey = greys_[level];
    if (level == levels.size()) levels.emplace_back();
    cv::GaussianBlur(grey, levels[level], {}, kBlurPixels);
    if (std::min(grey.cols, grey.rows) < 2 * kMinSide) return;
    cv::pyrDown(grey, greys_[level + 1]);
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

namespace {

constexpr std::uint32_t kCells = 32;  // along the longer side: the texture is taken from all over the picture
constexpr double kMinGradient = kGreyWhite / 256;  // a pixel
constexpr double kWeakGradient = 0.05;             // of the strongest: mostly noise
constexpr float kMargin = 4;

}  // namespace

std::vector<Point> textured_points(const cv::Mat& grey, std::size_t count) {
  const int side = std::max(8, std::max(grey.cols, grey.rows) / static_cast<int>(kCells));
  const int columns = (grey.cols - 1) / side + 1, rows = (grey.rows - 1) / side + 1;
  std::vector<std::vector<Point>> cells(static_cast<std::size_t>(columns * rows));
  const std::size_t most = std::max<std::size_t>(1, count / cells.size());
  const auto keep_strongest = [most](std::vector<Point>& cell) {
    if (cell.size() <= most) return;
    std::ranges::nth_element(cell, cell.begin() + static_cast<std::ptrdiff_t>(most), std::greater(),
                             gradient_of);
    cell.resize(most);
  };
  for (int y = static_cast<int>(kMargin); y < grey.rows - static_cast<int>(kMargin); ++y) {
    const auto *above = grey.ptr<float>(y - 1), *row = grey.ptr<float>(y), *below = grey.ptr<float>(y + 1);
    for (int x = static_cast<int>(kMargin); x < grey.cols - static_cast<int>(kMargin); ++x) {
      const Point point{static_cast<float>(x), static_cast<float>(y), row[x], (row[x + 1] - row[x - 1]) / 2,
                        (below[x] - above[x]) / 2};
      if (gradient_of(point) < kMinGradient) continue;
      std::vector<Point>& cell = cells[static_cast<std::size_t>(y / side * columns + x / side)];
      cell.push_back(point);
      if (cell.size() >= 4 * most) keep_strongest(cell);
    }
  }
  std::vector<Point> points;
  for (std::vector<Point>& cell : cells) {
    keep_strongest(cell);
    points.insert(points.end(), cell.begin(), cell.end());
  }
  if (points.empty()) return points;
  const double weak = kWeakGradient * gradient_of(*std::ranges::max_element(points, {}, gradient_of));
  std::erase_if(points, [&](const Point& point) { return gradient_of(point) < weak; });
  return points;
}

}  // namespace nutik::motion
