#include "opencl/function_map.hpp"

#include <algorithm>

#include "opencl/kernel_layout.hpp"

namespace nutik {
namespace {

class Mapper {
 public:
  Mapper(const MaskMap& map, const Band& band) : map_(map), band_(band), grid_({map.width, map.height, 1}) {
    functions_.tiles.reserve(band.sum_tiles);
    functions_.of_tile.reserve(band.sum_tiles);
    functions_.of_lane.reserve(band.sum_tiles * kTilePixels);
    if (!map.mixed.empty()) functions_.shares.reserve(band.sum_tiles * kTilePixels);
  }

  FunctionMap mapped() {
    for (std::uint64_t tile = 0; tile < band_.tile_count; ++tile) {
      const std::uint64_t in_picture = band_.tile_in_picture(tile);
      if (map_.mixed.empty()) {
        add(in_picture);
        continue;
      }
      functions_.first_of.push_back(static_cast<std::uint32_t>(functions_.tiles.size()));
      const auto mixed = std::ranges::lower_bound(map_.mixed_tiles, in_picture, {}, &MixedTile::tile);
      if (mixed != map_.mixed_tiles.end() && mixed->tile == in_picture) {
        for (const std::uint8_t region : mixed->regions) add_share(in_picture, region);
      } else {
        add(in_picture);
        functions_.shares.resize(functions_.of_lane.size());
      }
    }
    if (functions_.is_mixed())
      functions_.first_of.push_back(static_cast<std::uint32_t>(functions_.tiles.size()));
    return std::move(functions_);
  }

 private:
  // A tile whose pixels have one function each.
  void add(std::uint64_t tile) {
    const std::size_t first = functions_.of_lane.size();
    functions_.of_lane.resize(first + kTilePixels);
    const auto lanes = std::span(functions_.of_lane).subspan(first);
    grid_.for_each_lane(
        tile, [&](std::uint32_t lane, std::uint64_t pixel) { lanes[lane] = map_.region_of_pixel[pixel]; });
    const bool same = std::ranges::all_of(lanes, [&](std::uint8_t function) { return function == lanes[0]; });
    functions_.tiles.push_back(static_cast<std::uint32_t>(tile));
    functions_.of_tile.push_back(same ? lanes[0] : kMixedFunctions);
  }

  // A tile for one of its functions.
  void add_share(std::uint64_t tile, std::uint8_t region) {
    functions_.tiles.push_back(static_cast<std::uint32_t>(tile));
    functions_.of_tile.push_back(region);
    functions_.of_lane.insert(functions_.of_lane.end(), kTilePixels, region);
    grid_.for_each_lane(tile, [&](std::uint32_t, std::uint64_t pixel) {
      functions_.shares.push_back(share_of(pixel, region));
    });
  }

  [[nodiscard]] std::uint16_t share_of(std::uint64_t pixel, std::uint8_t region) const {
    const std::span<const Share> shares = map_.mixed.of(pixel);
    if (shares.empty()) return map_.region_of_pixel[pixel] == region ? kWholeShare : 0;
    const auto found = std::ranges::find(shares, region, &Share::of);
    return found == shares.end() ? std::uint16_t{0} : found->size;
  }

  const MaskMap& map_;
  const Band& band_;
  TileGrid grid_;
  FunctionMap functions_;
};

}  // namespace

FunctionMap map_functions(const MaskMap& map, const Band& band) { return Mapper(map, band).mapped(); }

}  // namespace nutik
