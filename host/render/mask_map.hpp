// Which functions a mask uses, and for which pixels: all that an exposure needs to know of a mask.
//
//   always:  depends on the mask alone; immutable, shared by the plans that were made with it
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "exposure/mask.hpp"

namespace nutik {

struct MaskRegion {
  std::uint8_t tag = 0;
  std::uint64_t pixel_count = 0;
};

// The values that pixels of a mask have, in increasing order: the functions that it uses. Decided here alone.
[[nodiscard]] std::vector<MaskRegion> regions_of(const Mask& mask);

struct MaskMap {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<MaskRegion> regions;            // at most 256
  std::vector<std::uint8_t> region_of_pixel;  // index into regions, row by row

  [[nodiscard]] static std::shared_ptr<const MaskMap> of(const Mask& mask);
  [[nodiscard]] bool is_of(const Mask& mask) const;
};

}  // namespace nutik
