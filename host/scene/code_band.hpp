// How far codes may lie apart that stand for one and the same light: a camera's noise, or so many codes.
//
// Codes are sorted into bins. Light is the same where bins lie within a window, which is twice as wide as codes may
// stray to either side.
#pragma once

#include <cstdint>
#include <vector>

#include "capture/noise_model.hpp"
#include "capture/picture.hpp"

namespace nutik {

class CodeBand {
 public:
  // Codes stray at least so far, in shares of white: compression and a camera that corrects its exposure see to that.
  static constexpr double kMinShare = 1.0 / 32;

  // Codes stray by up to `codes` to either side.
  static CodeBand of_codes(const CaptureFormat& capture, std::uint32_t codes);
  // By three standard deviations of the capture's noise, or kMinShare where that is more.
  static CodeBand of_noise(const CaptureFormat& capture, const CameraNoise& noise);

  [[nodiscard]] std::uint32_t bin(std::uint32_t channel, std::uint32_t code) const {
    return bins_[channel][code];
  }
  // Of bins that stand for the same light.
  [[nodiscard]] std::uint32_t window() const { return window_; }
  // How many there are, over all channels.
  [[nodiscard]] std::uint32_t bin_count() const;

 private:
  std::vector<std::vector<std::uint32_t>> bins_;  // [channel][code], never decreasing
  std::uint32_t window_ = 1;
};

}  // namespace nutik
