// How an exposure is cut so that no buffer is larger than the device allocates at a time.
//
//   in:      a picture's shape and what of it is mixed, or a plan's tables, an arithmetic, the device
//   out:     bands: rows of tiles, whole or cut to what a rectangle needs, whose sums fit
//            slices: planned blocks in a row, whose tables fit
//   always:  one band and one slice where everything fits, which is usual
//
//              blocks in time order ──►
//              slice 0              slice 1
//              chunk 0   chunk 1    chunk 2   chunk 3
//            ┌─────────┬──────────┬─────────┬─────────
//     band 0 │ launch 1│ launch 3 │ launch 5│ …            each band has its own sums, from the first
//     band 1 │ launch 2│ launch 4 │ launch 6│ …            launch until it is developed into its raster
//            └─────────┴──────────┴─────────┴─────────
//
// Payloads come in chunks (block_feed.hpp), which end where a slice does. Chunks hold all tiles of their blocks,
// so a kernel finds a tile by its number in the picture; everything else that it
// reads and writes is the band's or the slice's own, and numbered from there. However it is cut, each pixel's sum is
// made of the same blocks in the same order: the picture is the same to the last bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "opencl/device.hpp"
#include "render/precision.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// Rows of tiles of a picture, or the same part of each; by itself a picture.
struct Band {
  std::uint64_t first_tile;  // in the picture
  std::uint64_t tile_count;
  std::uint32_t columns;          // of tiles
  std::uint32_t skipped_columns;  // of the picture's, between a row of the band and its next
  std::uint32_t first_row;        // of pixels, in the picture
  std::uint32_t first_column;     // likewise
  Shape shape;
  std::uint64_t sum_tiles;  // whose sums it has: a mixed tile counts once for each of its functions
  friend bool operator==(const Band&, const Band&) = default;

  // Tile `tile` of the band, in the picture.
  [[nodiscard]] std::uint64_t tile_in_picture(std::uint64_t tile) const {
    return first_tile + tile + tile / columns * skipped_columns;
  }
};

// Planned blocks [first_block, last_block), and their rows of the plan's tables, [first_row, last_row). Behind these
// come those of the corrections of some of the blocks, as many for each as it has itself.
struct TableSlice {
  std::size_t first_block;
  std::size_t last_block;
  std::uint64_t first_row;
  std::uint64_t last_row;
  std::vector<std::size_t> corrected{};  // planned blocks, in time order
  std::uint64_t corrected_rows = 0;

  [[nodiscard]] std::uint64_t row_count() const { return last_row - first_row + corrected_rows; }
};

// What the sums of so many tiles take.
[[nodiscard]] std::uint64_t sums_bytes(std::uint64_t tile_count, std::uint32_t channels, Precision precision);

// The bands of the tiles that a rectangle of a picture meets, from top to bottom, all but the last of the same
// height. A band's sums take no less than its raster, or its function or share of each pixel; they take at most
// `max_bytes`, or are of one row of tiles. Throws DeviceError where not even one row fits.
[[nodiscard]] std::vector<Band> cut_picture(const Shape& shape, const Rectangle& rectangle, Precision precision,
                                            const DeviceInfo& device, std::uint64_t max_bytes = ~std::uint64_t{0},
                                            std::span<const MixedTile> mixed = {});

// What a table has in each of its rows for every function.
struct TableNumbers {
  std::size_t bytes;       // of a number
  bool has_corrections;    // rows of corrections lie behind a slice's own
  std::size_t levels = 1;  // numbers, each in a part of the table by itself (sample_combiner.hpp)

  // Weights or boundaries.
  [[nodiscard]] static TableNumbers of(Precision precision);
};

// The slices of a plan in time order; none of a plan without blocks. A table of a slice takes at most `max_bytes`, or
// is of one block. Throws DeviceError where the table of a single block does not fit.
[[nodiscard]] std::vector<TableSlice> cut_tables(const RenderPlan& plan, const TableNumbers& numbers,
                                                 const DeviceInfo& device, std::uint64_t max_bytes = ~std::uint64_t{0});

// That `what` takes more than the device allocates at a time, and the way out by other settings.
[[nodiscard]] DeviceError too_large(const DeviceInfo& device, std::uint64_t bytes, std::string_view what,
                                    std::string_view way_out, std::vector<Setting> settings);

}  // namespace nutik
