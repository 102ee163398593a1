// Pictures moved by fractions of a pixel, in light.
//
//   in:      a raster of codes, a warp from the new picture's places to its own
//   out:     codes: at each place the cubic (Catmull and Rom's) through the light of 4 x 4 pixels round it, no darker
//            than the darkest of them and no brighter than the brightest
//   always:  moved by whole pixels, codes stay as they are. What the raster does not show is left as it was in `warped`
//
// Between pixels a picture loses noise and sharpness: half a pixel from both sides noise has 0.41 of its variance left;
// half a pixel along a side waves of four pixels have 0.88 of their contrast left, of eight pixels 0.99.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "align/light_tables.hpp"
#include "align/warp.hpp"
#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"

namespace nutik {

class LightWarp {
 public:
  // Of rasters of this format; `area` is what the new picture shows of the places that warps start from.
  LightWarp(const CaptureFormat& format, const Rectangle& area);

  // On all cores. Throws CodeAboveWhite.
  void take(std::span<const std::byte> raster, const Warp& warp, std::span<std::byte> warped);

  [[nodiscard]] static std::uint64_t bytes(const CaptureFormat& format);

 private:
  template <typename Code>
  void read_light(const Code* raster);
  template <typename Code>
  void write_row(const Warp& warp, std::uint32_t row, Code* warped) const;

  CaptureFormat format_;
  Rectangle area_;
  LightTables tables_;
  std::vector<float> light_;  // of the raster, a plane for each channel, with a border
};

}  // namespace nutik
