// How the pixels of a picture are cut into work-items; kernels/items.clh is the kernels' side.
//
//   in:      a device and an arithmetic, or what somebody wants to try
//   out:     pixels, tiles and lanes of a work-item
//   always:  an item owns whole lanes, and a tile whole items
#pragma once

#include <cstdint>

#include "imev/tile.hpp"
#include "opencl/device.hpp"
#include "render/precision.hpp"

namespace nutik {

struct OpenClOptions;

struct WorkShape {
  std::uint32_t item_pixels;  // of a tile
  std::uint32_t item_tiles;
  std::uint32_t lanes;
  std::uint32_t group_items;
  std::uint32_t rows_at_once = 1;  // loads of so many rows are under way at once
  std::uint32_t table_copies = 0;  // of light of 256 codes, beside a group; 0: read from where the host wrote it

  // Rows of weights that lie side by side for each function: NUTIK_TABLE_ROWS in kernels/row_groups.clh.
  static constexpr std::uint32_t kMaxTableRows = 4;
  [[nodiscard]] std::uint32_t table_rows() const { return lanes < 8 ? 1 : kMaxTableRows; }

  // Work-items for a picture of so many tiles.
  [[nodiscard]] std::uint64_t items(std::uint64_t tile_count) const {
    return (tile_count + item_tiles - 1) / item_tiles * (kTilePixels / item_pixels);
  }
};

// The shape that suits a device and an arithmetic, unless the options state one: four pixels an item on a GPU, 16
// tiles an item on a CPU with vectors (docs/explanation/performance.md). UsageError if it does not divide a tile.
[[nodiscard]] WorkShape work_shape(const OpenClOptions& options, Precision precision,
                                   const DeviceInfo& device);

// The samples of a tile that one launch may read so that no loop of the kernels reaches the device's loop_limit.
[[nodiscard]] std::uint64_t max_samples_a_launch(const DeviceInfo& device, const WorkShape& shape);

}  // namespace nutik
