// Codes as light, and light as the code next to it, by tables.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
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
    while (black_ + 1 < white_code && thresholds_[black_ + 1] <= 0) ++black_;
    thresholds_.push_back(std::numeric_limits<double>::infinity());
    first_cell_ = cell_of(thresholds_[black_ + 1]);
    std::uint32_t code = black_;
    for (std::uint64_t cell = first_cell_; cell <= cell_of(1.0); ++cell) {
      while (thresholds_[code + 1] <= std::bit_cast<double>(cell << kPlaceBits)) ++code;
      first_code_.push_back(code);
    }
  }

  // Throws CodeAboveWhite.
  [[nodiscard]] double light_of(std::uint32_t code) const {
    if (code >= light_.size()) throw CodeAboveWhite(code);
    return light_[code];
  }

  // The last code that begins no later; that of black for less light.
  [[nodiscard]] std::uint32_t code_of(double light) const {
    if (!(light >= thresholds_[black_ + 1])) return black_;
    light = std::min(light, 1.0);
    const double* next = thresholds_.data() + first_code_[cell_of(light) - first_cell_] + 1;
    while (*next <= light) ++next;
    return static_cast<std::uint32_t>(next - thresholds_.data()) - 1;
  }

 private:
  // A cell holds the light whose doubles share all bits but so many last ones: 8192 cells from a light to its double.
  // Four codes at most begin in one, or more by a gamma below 1.
  static constexpr int kPlaceBits = 52 - 13;
  static std::uint64_t cell_of(double light) { return std::bit_cast<std::uint64_t>(light) >> kPlaceBits; }

  std::vector<double> light_;              // of each code
  std::vector<double> thresholds_;         // the least light of each, and none behind white
  std::uint32_t black_ = 0;                // the last code without light
  std::uint64_t first_cell_ = 0;           // has the first code with light
  std::vector<std::uint32_t> first_code_;  // at the start of each cell
};

}  // namespace nutik
