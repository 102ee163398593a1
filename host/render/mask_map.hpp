// Which functions a mask uses, for which pixels, and where they are mixed: all that an exposure needs to know of a mask.
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
  std::uint64_t pixel_count = 0;  // that it has a share of
};

// The values that pixels of a mask have or share, in increasing order: the functions that it uses. Decided here alone.
[[nodiscard]] std::vector<MaskRegion> regions_of(const Mask& mask);

// A tile with a mixed pixel, and the regions that its pixels have or share.
struct MixedTile {
  std::uint32_t tile = 0;  // of the picture's grid (imev/tile.hpp)
  std::vector<std::uint8_t> regions;
};

struct MaskMap {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<MaskRegion> regions;            // at most 256
  std::vector<std::uint8_t> region_of_pixel;  // index into regions, row by row; of a mixed pixel its tag's
  MixedPixels mixed;                          // with regions for tags
  std::vector<MixedTile> mixed_tiles;         // by increasing number

  [[nodiscard]] static std::shared_ptr<const MaskMap> of(const Mask& mask);
  [[nodiscard]] bool is_of(const Mask& mask) const;
};

}  // namespace nutik
