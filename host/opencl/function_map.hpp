// Which functions each pixel is exposed with, as the kernels read it.
#pragma once

#include <cstdint>
#include <vector>

#include "opencl/allocation_cuts.hpp"
#include "render/mask_map.hpp"

namespace nutik {

// Tiles whose sums a band has, in the order of its own. A mixed one (MixedTile) is there once for each of its mask
// values, of which each pixel has the function after its own delay.
struct FunctionMap {
  std::vector<std::uint32_t> tiles;    // in the picture
  std::vector<std::uint16_t> of_lane;  // [tile][64]: indices of a plan's functions
  std::size_t lane_bytes = 1;          // of such an index on the device: 2 where pixels have delays
  std::vector<std::uint16_t> of_tile;  // the tile's own where all its pixels agree, else kMixedFunctions
  // Where some tile is mixed:
  std::vector<std::uint32_t> first_of;  // of each tile of the band, and one more: where its sums begin
  std::vector<std::uint16_t> shares;    // [tile][64]: of kWholeShare; 0 of tiles that are not mixed

  [[nodiscard]] bool is_mixed() const { return !first_of.empty(); }
  [[nodiscard]] std::uint64_t bytes() const {
    return of_lane.size() * lane_bytes + tiles.size() * (sizeof(std::uint32_t) + sizeof(std::uint16_t)) +
           first_of.size() * sizeof(std::uint32_t) + shares.size() * sizeof(std::uint16_t);
  }
};

// For the tiles of a band.
[[nodiscard]] FunctionMap map_functions(const MaskMap& map, const Band& band);

}  // namespace nutik
