#include "scene/code_band.hpp"

#include <algorithm>

namespace nutik {
namespace {

// Of every code that may be held: damaged files have some above white.
std::size_t code_count(const CaptureFormat& capture) { return std::size_t{1} << 8 * capture.code_bytes; }

}  // namespace

CodeBand CodeBand::of_codes(const CaptureFormat& capture, std::uint32_t codes) {
  CodeBand band;
  std::vector<std::uint32_t> bins(code_count(capture));
  for (std::uint32_t code = 0; code < bins.size(); ++code) bins[code] = std::min(code, capture.white_code);
  band.bins_.assign(capture.shape.channels, bins);
  band.window_ = 2 * std::min(codes, capture.white_code) + 1;
  return band;
}

CodeBand CodeBand::of_noise(const CaptureFormat& capture, const CameraNoise& noise) {
  constexpr double kSigmas = 3.0;
  constexpr std::uint32_t kBinsToASide = 8;
  const double least = std::max(1.0, kMinShare * capture.white_code);
  CodeBand band;
  for (std::uint32_t channel = 0; channel < capture.shape.channels; ++channel) {
    std::vector<std::uint32_t>& bins = band.bins_.emplace_back();
    double place = 0;  // in bins: codes that stray further are packed closer
    for (std::uint32_t code = 0; code <= capture.white_code; ++code) {
      bins.push_back(static_cast<std::uint32_t>(place));
      place += kBinsToASide / std::max(least, kSigmas * noise.sd(channel, code));
    }
    bins.resize(code_count(capture), bins.back());
  }
  band.window_ = 2 * kBinsToASide + 1;
  return band;
}

std::uint32_t CodeBand::bin_count() const {
  std::uint32_t count = 0;
  for (const std::vector<std::uint32_t>& bins : bins_) count = std::max(count, bins.back() + 1);
  return count;
}

}  // namespace nutik
