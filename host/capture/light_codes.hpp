// Codes as light, and light as the code next to it, by tables.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "capture/transfer.hpp"

namespace nutik {

// A code that stands for no light.
struct CodeAboveWhite : std::runtime_error {
  explicit CodeAboveWhite(std::uint32_t above) : std::runtime_error("a code is above white"), code(above) {}
  std::uint32_t code;
};

class LightCodes {
 public:
  LightCodes(const Transfer& transfer, std::uint32_t white_code)
      : light_(transfer.light_of_codes(white_code)), thresholds_(transfer.code_thresholds(white_code)) {
    std::uint32_t code = 0;
    for (std::size_t step = 0; step <= kSteps; ++step) {
      const double light = static_cast<double>(step) / static_cast<double>(kSteps - 1);
      while (code < white_code && thresholds_[code + 1] <= light) ++code;
      first_code_.push_back(code);
    }
  }

  // Throws CodeAboveWhite.
  [[nodiscard]] double light_of(std::uint32_t code) const {
    if (code >= light_.size()) throw CodeAboveWhite(code);
    return light_[code];
  }

  // The last code that begins no later.
  [[nodiscard]] std::uint32_t code_of(double light) const {
    const auto step = static_cast<std::size_t>(std::clamp(light, 0.0, 1.0) * static_cast<double>(kSteps - 1));
    const auto begin = thresholds_.begin() + 1;
    const auto after = std::upper_bound(begin + first_code_[step], begin + first_code_[step + 1], light);
    return static_cast<std::uint32_t>(after - begin);
  }

 private:
  static constexpr std::size_t kSteps = std::size_t{1} << 16;

  std::vector<double> light_;              // of each code
  std::vector<double> thresholds_;         // the least light of each
  std::vector<std::uint32_t> first_code_;  // at the start of each of many equal steps of light
};

}  // namespace nutik
