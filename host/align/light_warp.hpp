// Pictures moved by fractions of a pixel, in light.
//
//   in:      a raster of codes, a warp from the new picture's places to its own
//   out:     codes: at each place the cubic (Catmull and Rom's) through the light of 4 x 4 pixels round it, no darker
//            than the darkest of them and no brighter than the brightest
//   always:  moved by whole pixels, codes stay as they are. What the raster does not show is left as it was in `warped`
//
// A shift by half a pixel in both directions reduces noise variance to 0.41; along one side waves of four pixels keep
// 0.88 of their contrast, of eight 0.99.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "align/warp.hpp"
#include "capture/light_codes.hpp"
#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "capture/transfer.hpp"

namespace nutik {

// Codes as light of single precision, and light as the code next to it: many at once, by tables.
//
//   always:  the code of a light is that of LightCodes, which takes one at a time
class LightTables {
 public:
  LightTables(const Transfer& transfer, std::uint32_t white_code);

  // Takes every `stride`-th code, as many as there is room for, at least one. Throws CodeAboveWhite, also for a code
  // between them.
  void lights_of(const std::uint8_t* codes, std::size_t stride, std::span<float> lights) const;
  void lights_of(const std::uint16_t* codes, std::size_t stride, std::span<float> lights) const;

  // The last codes that begin no later than lights, 0 if none does; `codes` has room for as many.
  void codes_of(std::span<const float> lights, std::uint32_t* codes) const;

 private:
  std::vector<float> light_;               // of each code
  // Of singles that share all bits but the last: their first code, and the last bits with which the next one begins.
  std::vector<std::uint32_t> cells_;
  std::int32_t first_cell_ = 0, cell_bits_ = 0;
};

class LightWarp {
 public:
  // Moves rasters of this format; `area` is what the new picture shows of the places that warps start from.
  LightWarp(const CaptureFormat& format, const Rectangle& area);

  // On all cores. Throws CodeAboveWhite.
  void take(std::span<const std::byte> raster, const Warp& warp, std::span<std::byte> warped) const;

  [[nodiscard]] static std::uint64_t bytes(const CaptureFormat& format);

 private:
  template <typename Code>
  class Part;

  CaptureFormat format_;
  Rectangle area_;
  LightTables tables_;
};

}  // namespace nutik
