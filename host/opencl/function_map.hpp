// Which function each pixel is exposed with, as the kernels read it.
#pragma once

#include <cstdint>
#include <vector>

#include "opencl/allocation_cuts.hpp"
#include "render/mask_map.hpp"

namespace nutik {

// of_lane: [tile][64] indices of a plan's functions. of_tile: the tile's own where all its pixels agree, else
// kMixedFunctions.
struct FunctionMap {
  std::vector<std::uint8_t> of_lane;
  std::vector<std::uint16_t> of_tile;
};

// Of the tiles of a band.
[[nodiscard]] FunctionMap map_functions(const MaskMap& map, const Band& band);

}  // namespace nutik
