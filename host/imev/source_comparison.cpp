#include "imev/source_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "imev/expected_values.hpp"

namespace nutik {
namespace {

std::uint32_t code_at(std::span<const std::byte> raster, std::uint64_t value, std::uint32_t code_bytes) {
  std::uint16_t code = 0;
  std::memcpy(&code, raster.data() + value * code_bytes, code_bytes);
  return code;
}

// What the band's own arithmetic rounds: standard deviations are kept in single precision.
constexpr double kBandRounding = 1e-6;

}  // namespace

SourceComparison::SourceComparison(const CaptureFormat& source)
    : source_(source), scale_(held_scale(source)),
      held_(held_format(source).sample_bytes()),
      before_(held_.size()) {
  for (std::uint32_t channel = 0; channel < source.shape.channels; ++channel) {
    const NoiseModel& noise = source.noise;
    std::vector<double>& band =
        bands_.emplace_back(std::size_t{source.white_code} * scale_ + 1, double(noise.tolerance));
    if (!noise.camera) continue;
    for (std::size_t code = 0; code < band.size(); ++code) {
      band[code] = noise.sigmas * noise.camera->sd(channel, static_cast<double>(code) / scale_);
    }
  }
}

void SourceComparison::add(const BlockView& block, std::uint32_t sample, std::span<const std::byte> raster) {
  if (!raster.empty() && raster.size() != source_.sample_bytes()) {
    throw std::logic_error("a sample's raster has the wrong size");
  }
  std::swap(held_, before_);
  block.read_sample(sample, held_);
  const std::size_t pixel_bytes = held_.size() / source_.shape.pixel_count();
  for (std::size_t at = 0; sample != 0 && at < held_.size(); at += pixel_bytes)
    record_count_ += std::memcmp(held_.data() + at, before_.data() + at, pixel_bytes) != 0 ? 1 : 0;
  if (raster.empty()) return;
  const std::uint32_t held_bytes = held_format(source_).code_bytes;
  for (std::uint64_t value = 0; value < source_.shape.value_count(); ++value) {
    const std::uint32_t held_code = code_at(held_, value, held_bytes);
    const double held = static_cast<double>(held_code) / scale_;
    const double error = std::abs(held - code_at(raster, value, source_.code_bytes));
    squares_ += error * error;
    const std::vector<double>& band = bands_[value % source_.shape.channels];
    if (error > band[std::min<std::size_t>(held_code, band.size() - 1)] * (1 + kBandRounding))
      ++values_beyond_;
    if (error > worst_.error) {
      worst_ = {error, block.extent().first_sample + sample, value / source_.shape.channels};
    }
  }
  value_count_ += source_.shape.value_count();
}

double SourceComparison::psnr() const {
  if (squares_ == 0) return std::numeric_limits<double>::infinity();
  const double peak = source_.white_code;
  return 10 * std::log10(peak * peak * static_cast<double>(value_count_) / squares_);
}

}  // namespace nutik
