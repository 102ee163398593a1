// Whether the codes of a picture are those of its light.
#pragma once

#include <cstdint>
#include <vector>

#include "capture/transfer.hpp"

namespace nutik::test {

// Code c stands for the light from thresholds[c] up to thresholds[c + 1]; 0 also for all that is darker, the
// white code for all that is brighter (docs/explanation/model.md, "From light to codes").
class RightCodes {
 public:
  RightCodes(const Transfer& transfer, std::uint32_t white_code)
      : white_code_(white_code), thresholds_(transfer.code_thresholds(white_code)) {}

  // Whether light that `light` is within `error` of can have this code.
  [[nodiscard]] bool can_be(std::uint32_t code, double light, double error) const {
    if (code > white_code_) return false;
    const bool high_enough = code == 0 || light + error >= thresholds_[code];
    const bool low_enough = code == white_code_ || light - error < thresholds_[code + 1];
    return high_enough && low_enough;
  }

 private:
  std::uint32_t white_code_;
  std::vector<double> thresholds_;
};

}  // namespace nutik::test
