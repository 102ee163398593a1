// Codes as light of single precision, and light as the code next to it: many at once, by tables.
//
//   always:  the code of a light is that of LightCodes, which takes one at a time. White's light is kWhite, so that the
//            darkest codes of any transfer function are normal singles
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
  static constexpr float kWhite = 0x1p64F;

  LightTables(const Transfer& transfer, std::uint32_t white_code);

  // Takes every `stride`-th code, as many as there is room for, at least one. Throws CodeAboveWhite, also for a code
  // between them.
  void lights_of(const std::uint8_t* codes, std::size_t stride, std::span<float> lights) const;
  void lights_of(const std::uint16_t* codes, std::size_t stride, std::span<float> lights) const;

  // The last codes that begin no later than lights, 0 if none does; `codes` has room for as many.
  void codes_of(std::span<const float> lights, std::uint32_t* codes) const;

 private:
  std::vector<float> light_;  // of each code
  // A cell holds singles that share all bits but the last: their first code, and the last bits with which the next one
  // begins.
  std::vector<std::uint32_t> cells_;
  std::int32_t first_cell_ = 0, cell_bits_ = 0;
};

}  // namespace nutik
