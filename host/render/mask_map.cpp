#include "render/mask_map.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <map>

#include "imev/tile.hpp"

namespace nutik {
namespace {

std::vector<MixedTile> mixed_tiles_of(const MaskMap& map) {
  const TileGrid grid({map.width, map.height, 1});
  std::map<std::uint64_t, std::bitset<kMaskValues>> found;
  for (std::size_t i = 0; i < map.mixed.pixels().size(); ++i) {
    const std::uint64_t pixel = map.mixed.pixels()[i];
    auto& regions = found[grid.tile_of(static_cast<std::uint32_t>(pixel % map.width),
                                       static_cast<std::uint32_t>(pixel / map.width))];
    for (const Share& share : map.mixed.shares(i)) regions.set(share.of);
  }
  std::vector<MixedTile> tiles;
  for (auto& [tile, regions] : found) {
    grid.for_each_lane(tile, [&, &held = regions](std::uint32_t, std::uint64_t pixel) {
      held.set(map.region_of_pixel[pixel]);
    });
    MixedTile& mixed = tiles.emplace_back(MixedTile{static_cast<std::uint32_t>(tile), {}});
    for (std::size_t region = 0; region < map.regions.size(); ++region) {
      if (regions[region]) mixed.regions.push_back(static_cast<std::uint8_t>(region));
    }
  }
  return tiles;
}

}  // namespace

std::vector<MaskRegion> regions_of(const Mask& mask) {
  const auto pixels = mask.pixels_per_tag();
  std::vector<MaskRegion> regions;
  for (std::uint32_t value = 0; value < kMaskValues; ++value) {
    if (pixels[value] > 0) regions.push_back({static_cast<std::uint8_t>(value), pixels[value]});
  }
  return regions;
}

std::shared_ptr<const MaskMap> MaskMap::of(const Mask& mask) {
  auto map = std::make_shared<MaskMap>(MaskMap{mask.width, mask.height, regions_of(mask), {}, {}, {}});
  std::array<std::uint8_t, kMaskValues> region_of_tag{};
  for (std::size_t r = 0; r < map->regions.size(); ++r) {
    region_of_tag[map->regions[r].tag] = static_cast<std::uint8_t>(r);
  }
  map->region_of_pixel.resize(mask.tags.size());
  std::ranges::transform(mask.tags, map->region_of_pixel.begin(),
                         [&](std::uint8_t tag) { return region_of_tag[tag]; });
  if (mask.is_soft()) {
    map->mixed = mask.mixed.renamed([&](std::uint8_t tag) { return region_of_tag[tag]; });
    map->mixed_tiles = mixed_tiles_of(*map);
  }
  return map;
}

bool MaskMap::is_of(const Mask& mask) const {
  if (mask.width != width || mask.height != height) return false;
  if (mask.is_soft() != !mixed.empty()) return false;
  if (mask.is_soft() &&
      mixed.renamed([&](std::uint8_t region) { return regions[region].tag; }) != mask.mixed) {
    return false;
  }
  // Masks whose values count from 0 are their own maps, which are compared many pixels at a time.
  if (std::size_t{regions.back().tag} + 1 == regions.size()) return mask.tags == region_of_pixel;
  return std::ranges::equal(mask.tags, region_of_pixel, [&](std::uint8_t tag, std::uint8_t region) {
    return tag == regions[region].tag;
  });
}

}  // namespace nutik
