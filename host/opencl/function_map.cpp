#include "opencl/function_map.hpp"

#include <algorithm>

#include "opencl/kernel_layout.hpp"

namespace nutik {
namespace {

class Mapper {
 public:
  Mapper(const MaskMap& map, const Band& band) : map_(map), band_(band), grid_({map.width, map.height, 1}) {
    if (map.has_delays()) functions_.lane_bytes = sizeof(std::uint16_t);
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
        for (const std::uint8_t tag : mixed->tags) add_share(in_picture, tag);
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
        tile, [&](std::uint32_t lane, std::uint64_t pixel) { lanes[lane] = map_.region_at(pixel); });
    finish(tile, lanes);
  }

  // A tile for one of its mask values. Pixels without a share of it have the function of one that has.
  void add_share(std::uint64_t tile, std::uint8_t tag) {
    const std::size_t first = functions_.of_lane.size();
    std::uint16_t stand_in = 0;
    grid_.for_each_lane(tile, [&](std::uint32_t, std::uint64_t pixel) {
      const Share share = share_of(pixel, tag);
      if (share.size > 0) stand_in = share.of;
      functions_.of_lane.push_back(share.of);
      functions_.shares.push_back(share.size);
    });
    const auto lanes = std::span(functions_.of_lane).subspan(first);
    const auto shares = std::span(functions_.shares).subspan(first);
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      if (shares[lane] == 0) lanes[lane] = stand_in;
    }
    finish(tile, lanes);
  }

  void finish(std::uint64_t tile, std::span<const std::uint16_t> lanes) {
    const bool same =
        std::ranges::all_of(lanes, [&](std::uint16_t function) { return function == lanes[0]; });
    functions_.tiles.push_back(static_cast<std::uint32_t>(tile));
    functions_.of_tile.push_back(same ? lanes[0] : kMixedFunctions);
  }

  // The pixel's share of a mask value, of its region; none: 0.
  [[nodiscard]] Share share_of(std::uint64_t pixel, std::uint8_t tag) const {
    const auto has_tag = [&](const Share& share) { return map_.regions[share.of].tag == tag; };
    const Share whole{map_.region_at(pixel), kWholeShare};
    const std::span<const Share> mixture = map_.mixed.of(pixel);
    const std::span<const Share> shares = mixture.empty() ? std::span(&whole, 1) : mixture;
    const auto found = std::ranges::find_if(shares, has_tag);
    return found == shares.end() ? Share{} : *found;
  }

  const MaskMap& map_;
  const Band& band_;
  TileGrid grid_;
  FunctionMap functions_;
};

}  // namespace

FunctionMap map_functions(const MaskMap& map, const Band& band) { return Mapper(map, band).mapped(); }

}  // namespace nutik
