#include "noise/still_window.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nutik {
namespace {

constexpr std::uint64_t kMaxPixels = 512 * 1024;
constexpr int kFlickerPasses = 4;                      // the first with all pixels
constexpr double kFlickerOutlier = 2.5;                // standard deviations: what moves is no flicker
constexpr std::size_t kMaxFlickerPixels = 32 * 1024;  // two numbers are found with fewer than all
constexpr double kMinFlickerPixels = 256;

// Every so many pixels of a row, and every so many rows.
std::uint32_t step_of(const Shape& shape) {
  std::uint32_t step = 1;
  while (shape.pixel_count() / step / step > kMaxPixels) ++step;
  return step;
}

}  // namespace

std::uint64_t StillWindow::pixel_count(const Shape& shape) {
  const std::uint64_t step = step_of(shape);
  return ((shape.width + step - 1) / step) * ((shape.height + step - 1) / step);
}

std::uint64_t StillWindow::window_bytes(const Shape& shape) {
  return pixel_count(shape) *
         (sizeof(std::uint64_t) + kWindowSamples * shape.channels * sizeof(std::uint16_t));
}

std::uint64_t StillWindow::measuring_bytes(const Shape& shape) {
  return pixel_count(shape) * (4 * sizeof(float) + sizeof(PixelNoise));
}

StillWindow::StillWindow(const CaptureFormat& capture) : format_(capture) {
  const Shape& shape = capture.shape;
  const std::uint32_t step = step_of(shape);
  pixels_.reserve(pixel_count(shape));
  for (std::uint32_t y = 0; y < shape.height; y += step) {
    for (std::uint32_t x = 0; x < shape.width; x += step) {
      pixels_.push_back(std::uint64_t{y} * shape.width + x);
    }
  }
  columns_ = (shape.width + step - 1) / step;
  neighbour_ = std::max<std::size_t>(1, kNeighbourPixels / step);
  codes_.resize(kWindowSamples * shape.channels * pixels_.size());
}

void StillWindow::add(std::span<const std::byte> raster) {
  if (is_full()) throw std::logic_error("a full window was given another sample");
  with_codes(format_.code_bytes, raster.data(), [&](const auto* codes) { add(codes); });
  ++samples_;
}

template <typename Code>
void StillWindow::add(const Code* raster) {
  const std::uint32_t channels = format_.shape.channels;
  for (std::uint32_t channel = 0; channel < channels; ++channel) {
    std::uint16_t* to = codes_.data() + (std::size_t{samples_} * channels + channel) * pixels_.size();
    for (std::size_t i = 0; i < pixels_.size(); ++i) to[i] = raster[pixels_[i] * channels + channel];
  }
}

// A line through the differences from the means, over the means; fitted again without the pixels that are
// far from it. Clipped codes do not follow the light and have no say.
StillWindow::Flicker StillWindow::flicker(const std::uint16_t* codes, std::span<const float> means) const {
  Flicker line;
  double limit = INFINITY;
  const std::size_t step = means.size() / kMaxFlickerPixels + 1;
  for (int pass = 0; pass < kFlickerPasses; ++pass) {
    double n = 0, sum_m = 0, sum_mm = 0, sum_d = 0, sum_md = 0, squares = 0;
    for (std::size_t i = 0; i < means.size(); i += step) {
      if (codes[i] == 0 || codes[i] >= format_.white_code) continue;
      const double mean = means[i], difference = codes[i] - mean;
      const double rest = difference - line.offset - line.gain * mean;
      if (std::abs(rest) > limit) continue;
      n += 1;
      sum_m += mean;
      sum_mm += mean * mean;
      sum_d += difference;
      sum_md += mean * difference;
      squares += rest * rest;
    }
    if (n < kMinFlickerPixels) return {};
    const double spread = sum_mm - sum_m * sum_m / n;
    line.gain = spread > n ? (sum_md - sum_m * sum_d / n) / spread : 0;  // a picture of one code has no gain
    line.offset = (sum_d - line.gain * sum_m) / n;
    limit = kFlickerOutlier * std::sqrt(squares / n) + 1;
  }
  return line;
}

std::vector<PixelNoise> StillWindow::measure(std::uint32_t channel) const {
  const std::size_t count = pixels_.size();
  std::vector<float> means(count);
  for (std::uint32_t k = 0; k < samples_; ++k) {
    const std::uint16_t* codes = plane(k, channel);
    for (std::size_t i = 0; i < count; ++i) means[i] += codes[i];
  }
  for (float& mean : means) mean /= static_cast<float>(samples_);

  // A second difference of independent noise has six times its variance.
  std::vector<float> before(count), last(count), bends(count);
  std::vector<PixelNoise> noise(count);
  const std::size_t down = neighbour_ * columns_;
  for (std::uint32_t k = 0; k < samples_; ++k) {
    const std::uint16_t* codes = plane(k, channel);
    const Flicker common = flicker(codes, means);
    const auto offset = static_cast<float>(common.offset), gain = static_cast<float>(common.gain);
    for (std::size_t i = 0; i < count; ++i) {
      const float rest = codes[i] - means[i] - offset - gain * means[i];
      bends[i] = rest - 2 * last[i] + before[i];
      before[i] = last[i];
      last[i] = rest;
    }
    if (k < 2) continue;
    for (std::size_t i = 0; i < count; ++i) {
      noise[i].variance += bends[i] * bends[i];
      if (i % columns_ + neighbour_ < columns_) noise[i].beside += bends[i] * bends[i + neighbour_];
      if (i + down < count) noise[i].below += bends[i] * bends[i + down];
    }
  }
  const auto scale = static_cast<float>(1 / (6.0 * (samples_ - 2)));
  for (std::size_t i = 0; i < count; ++i) {
    const PixelNoise& sums = noise[i];
    const std::uint64_t x = pixels_[i] % format_.shape.width, y = pixels_[i] / format_.shape.width;
    noise[i] = {means[i], sums.variance * scale, sums.beside * scale, sums.below * scale,
                static_cast<std::uint32_t>(2 * (y % 2) + x % 2)};
  }
  return noise;
}

// The sum of the squares of n second differences has the variance 2 (36 n + 2 · 16 (n - 1) + 2 · (n - 2)), in units of
// the noise's own squared: neighbours share two samples of three. A chi-squared sum of the same mean and variance
// has as many degrees of freedom as this.
double StillWindow::degrees_of_freedom(std::uint32_t samples) {
  const double n = samples - 2.0;
  const double of_pairs = n >= 2 ? 32 * (n - 1) + 2 * (n - 2) : 0;
  return 36 * n * n / (36 * n + of_pairs);
}

}  // namespace nutik
