#include "render/mask_map.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <map>
#include <span>
#include <utility>

#include "imev/tile.hpp"
#include "render/delayed_pairs.hpp"

namespace nutik {
namespace {

std::vector<MixedTile> mixed_tiles_of(const Mask& mask) {
  const TileGrid grid({mask.width, mask.height, 1});
  std::map<std::uint64_t, std::bitset<kMaskValues>> found;
  for (std::size_t i = 0; i < mask.mixed.pixels().size(); ++i) {
    const std::uint64_t pixel = mask.mixed.pixels()[i];
    auto& tags = found[grid.tile_of(static_cast<std::uint32_t>(pixel % mask.width),
                                    static_cast<std::uint32_t>(pixel / mask.width))];
    for (const Share& share : mask.mixed.shares(i)) tags.set(share.of);
  }
  std::vector<MixedTile> tiles;
  for (auto& [tile, tags] : found) {
    grid.for_each_lane(tile,
                       [&, &held = tags](std::uint32_t, std::uint64_t pixel) { held.set(mask.tags[pixel]); });
    MixedTile& mixed = tiles.emplace_back(MixedTile{static_cast<std::uint32_t>(tile), {}});
    for (std::uint32_t tag = 0; tag < kMaskValues; ++tag) {
      if (tags[tag]) mixed.tags.push_back(static_cast<std::uint8_t>(tag));
    }
  }
  return tiles;
}

}  // namespace

std::vector<MaskRegion> regions_of(const Mask& mask) {
  const auto pixels = mask.pixels_per_tag();
  std::vector<MaskRegion> regions;
  for (std::uint32_t value = 0; value < kMaskValues; ++value) {
    if (pixels[value] > 0) regions.push_back({static_cast<std::uint8_t>(value), pixels[value], 0});
  }
  return regions;
}

std::shared_ptr<const MaskMap> MaskMap::of(const Mask& mask, std::shared_ptr<const DelayMap> delays) {
  auto map = std::make_shared<MaskMap>();
  map->width = mask.width;
  map->height = mask.height;
  if (delays) {
    const DelayedPairs pairs(mask, *delays);
    map->regions.resize(pairs.count());
    for_each_share(mask, [&](std::uint64_t pixel, std::uint8_t tag) {
      const std::uint16_t delay = delays->delay_of_pixel[pixel];
      MaskRegion& region = map->regions[pairs.number_of(tag, delay)];
      region = {tag, region.pixel_count + 1, delays->delays_ns[delay]};
    });
    const auto region_of = [&](std::uint16_t tag, std::uint64_t pixel) {
      return pairs.number_of(static_cast<std::uint8_t>(tag), delays->delay_of_pixel[pixel]);
    };
    map->delayed_region_of_pixel.reserve(mask.tags.size());
    for (std::uint64_t pixel = 0; pixel < mask.tags.size(); ++pixel)
      map->delayed_region_of_pixel.push_back(region_of(mask.tags[pixel], pixel));
    map->mixed = mask.mixed.renamed(region_of);
  } else {
    map->regions = regions_of(mask);
    std::array<std::uint8_t, kMaskValues> region_of_tag{};
    for (std::size_t r = 0; r < map->regions.size(); ++r)
      region_of_tag[map->regions[r].tag] = static_cast<std::uint8_t>(r);
    map->region_of_pixel.resize(mask.tags.size());
    std::ranges::transform(mask.tags, map->region_of_pixel.begin(),
                           [&](std::uint8_t tag) { return region_of_tag[tag]; });
    map->mixed = mask.mixed.renamed([&](std::uint16_t tag, std::uint64_t) { return region_of_tag[tag]; });
  }
  if (mask.is_soft()) map->mixed_tiles = mixed_tiles_of(mask);
  map->delays = std::move(delays);
  return map;
}

bool MaskMap::is_of(const Mask& mask, const DelayMap* its_delays) const {
  if (mask.width != width || mask.height != height) return false;
  if (mask.is_soft() != !mixed.empty()) return false;
  if ((its_delays != nullptr) != has_delays()) return false;
  const auto tag_of = [&](std::uint16_t region, std::uint64_t = 0) { return regions[region].tag; };
  if (has_delays() && its_delays != delays.get() && *its_delays != *delays) return false;
  if (mask.is_soft() && mixed.renamed(tag_of) != mask.mixed) return false;
  if (has_delays()) {
    return std::ranges::equal(mask.tags, delayed_region_of_pixel,
                              [&](std::uint8_t tag, std::uint16_t region) { return tag == tag_of(region); });
  }
  // Masks whose values count from 0 are their own maps, which are compared many pixels at a time.
  if (std::size_t{regions.back().tag} + 1 == regions.size()) return mask.tags == region_of_pixel;
  return std::ranges::equal(mask.tags, region_of_pixel,
                            [&](std::uint8_t tag, std::uint8_t region) { return tag == tag_of(region); });
}

}  // namespace nutik
