#include "opencl/function_map.hpp"

#include <algorithm>

#include "opencl/kernel_layout.hpp"

namespace nutik {

FunctionMap map_functions(const MaskMap& map, const Band& band) {
  const TileGrid grid({map.width, map.height, 1});
  FunctionMap functions;
  functions.of_lane.resize(band.tile_count * kTilePixels);
  functions.of_tile.resize(band.tile_count);
  for (std::uint64_t tile = 0; tile < band.tile_count; ++tile) {
    std::uint8_t* lanes = functions.of_lane.data() + tile * kTilePixels;
    grid.for_each_lane(band.tile_in_picture(tile), [&](std::uint32_t lane, std::uint64_t pixel) {
      lanes[lane] = map.region_of_pixel[pixel];
    });
    const bool same =
        std::all_of(lanes, lanes + kTilePixels, [&](std::uint8_t function) { return function == lanes[0]; });
    functions.of_tile[tile] = same ? lanes[0] : kMixedFunctions;
  }
  return functions;
}

}  // namespace nutik
