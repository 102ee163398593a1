// Which functions a mask uses, for which pixels, and where they are mixed: all that an exposure needs to know of a
// mask.
//
// A region is the pixels of one mask value; with a time map (exposure/delay_map.hpp) those that have the same delay
// besides, for they share a function and its tables.
//
//   always:  depends on the mask and the time map alone; immutable, shared by the plans that were made with them
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "exposure/delay_map.hpp"
#include "exposure/mask.hpp"

namespace nutik {

struct MaskRegion {
  std::uint8_t tag = 0;
  std::uint64_t pixel_count = 0;  // that it has a share of
  std::int64_t delay_ns = 0;      // by which its function comes later
};

// The values that pixels of a mask have or share, in increasing order: the functions that it uses. Decided here alone.
// Without delays.
[[nodiscard]] std::vector<MaskRegion> regions_of(const Mask& mask);

// A tile with a mixed pixel, and the mask values that its pixels have or share.
struct MixedTile {
  std::uint32_t tile = 0;  // of the picture's grid (imev/tile.hpp)
  std::vector<std::uint8_t> tags;
};

struct MaskMap {
  // Kernels count regions in 16 bits where pixels have delays, else in 8.
  static constexpr std::size_t kMaxRegions = 1u << 16;

  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<MaskRegion> regions;            // by tag, then delay
  std::vector<std::uint8_t> region_of_pixel;  // index into regions, row by row; of a mixed pixel its tag's
  MixedPixels mixed;                          // by index of region
  std::vector<MixedTile> mixed_tiles;         // by increasing number

  // Where pixels have delays, in the place of region_of_pixel, which is empty then.
  std::shared_ptr<const DelayMap> delays;
  std::vector<std::uint16_t> delayed_region_of_pixel;

  // Throws InputError where mask and delays have different sizes, or more pairs of both occur than there can be
  // regions.
  [[nodiscard]] static std::shared_ptr<const MaskMap> of(const Mask& mask,
                                                         std::shared_ptr<const DelayMap> delays = nullptr);
  [[nodiscard]] bool is_of(const Mask& mask, const DelayMap* delays) const;

  [[nodiscard]] bool has_delays() const { return delays != nullptr; }
  [[nodiscard]] std::uint16_t region_at(std::uint64_t pixel) const {
    return has_delays() ? delayed_region_of_pixel[pixel] : region_of_pixel[pixel];
  }
  // What it takes to say which region each pixel has.
  [[nodiscard]] std::uint64_t bytes() const {
    return region_of_pixel.size() + delayed_region_of_pixel.size() * sizeof(std::uint16_t);
  }
};

}  // namespace nutik
