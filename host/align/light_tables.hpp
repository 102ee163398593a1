// Codes as light of single precision, and light as the code next to it: many at once, by tables.
//
//   always:  the code of a light is that of LightCodes, which takes one at a time
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/light_codes.hpp"
#include "capture/transfer.hpp"

namespace nutik {

class LightTables {
 public:
  LightTables(const Transfer& transfer, std::uint32_t white_code);

  // Of every `stride`-th code, as many as there is room for, one at least. Throws CodeAboveWhite, for one between them,
  // too.
  void lights_of(const std::uint8_t* codes, std::size_t stride, std::span<float> lights) const;
  void lights_of(const std::uint16_t* codes, std::size_t stride, std::span<float> lights) const;

  // The last codes that begin no later than lights of [0, 1]; `codes` has room for as many.
  void codes_of(std::span<const float> lights, std::uint32_t* codes) const;

 private:
  std::vector<float> light_;               // of each code
  std::vector<float> begins_;              // the least light of each; behind them, what no light reaches
  std::vector<std::uint32_t> first_code_;  // at the start of each of many equal steps of light
  std::uint32_t half_ = 1;  // a power of 2: no step has twice as many codes that begin within it
};

}  // namespace nutik
