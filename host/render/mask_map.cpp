#include "render/mask_map.hpp"

#include <algorithm>
#include <array>

namespace nutik {

std::vector<MaskRegion> regions_of(const Mask& mask) {
  const auto pixels = mask.pixels_per_tag();
  std::vector<MaskRegion> regions;
  for (std::uint32_t value = 0; value < kMaskValues; ++value) {
    if (pixels[value] > 0) regions.push_back({static_cast<std::uint8_t>(value), pixels[value]});
  }
  return regions;
}

std::shared_ptr<const MaskMap> MaskMap::of(const Mask& mask) {
  auto map = std::make_shared<MaskMap>(MaskMap{mask.width, mask.height, regions_of(mask), {}});
  std::array<std::uint8_t, kMaskValues> region_of_tag{};
  for (std::size_t r = 0; r < map->regions.size(); ++r) {
    region_of_tag[map->regions[r].tag] = static_cast<std::uint8_t>(r);
  }
  map->region_of_pixel.resize(mask.tags.size());
  std::ranges::transform(mask.tags, map->region_of_pixel.begin(),
                         [&](std::uint8_t tag) { return region_of_tag[tag]; });
  return map;
}

bool MaskMap::is_of(const Mask& mask) const {
  if (mask.width != width || mask.height != height) return false;
  // Masks whose values count from 0 are their own maps, which are compared many pixels at a time.
  if (std::size_t{regions.back().tag} + 1 == regions.size()) return mask.tags == region_of_pixel;
  return std::ranges::equal(mask.tags, region_of_pixel,
                            [&](std::uint8_t tag, std::uint8_t region) { return tag == regions[region].tag; });
}

}  // namespace nutik
