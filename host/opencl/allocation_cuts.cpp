#include "opencl/allocation_cuts.hpp"

#include <algorithm>
#include <numeric>

#include "capture/format.hpp"
#include "opencl/kernel_layout.hpp"
#include "opencl/kernel_numbers.hpp"
#include "opencl/work_shape.hpp"

namespace nutik {

std::uint64_t sums_bytes(std::uint64_t tile_count, std::uint32_t channels, Precision precision) {
  return tile_count * channels * kTilePixels * sum_bytes(precision);
}

std::vector<Band> cut_picture(const Shape& shape, const Rectangle& rectangle, Precision precision,
                              const DeviceInfo& device, std::uint64_t max_bytes, std::span<const MixedTile> mixed) {
  const TileGrid grid(shape);
  const std::uint32_t left = rectangle.x / kTileSide;
  const std::uint32_t top = rectangle.y / kTileSide;
  const std::uint32_t columns = (rectangle.x + rectangle.width - 1) / kTileSide + 1 - left;
  const std::uint32_t rows = (rectangle.y + rectangle.height - 1) / kTileSide + 1 - top;
  std::vector<std::uint64_t> sum_tiles(rows, columns);  // by row of tiles
  for (const MixedTile& tile : mixed) {
    const std::uint32_t row = tile.tile / grid.columns(), column = tile.tile % grid.columns();
    if (row < top || row >= top + rows || column < left || column >= left + columns) continue;
    sum_tiles[row - top] += tile.tags.size() - 1;
  }
  const std::uint64_t row_bytes = sums_bytes(std::ranges::max(sum_tiles), shape.channels, precision);
  if (device.largest_allocation_bytes < row_bytes) {
    throw too_large(device, row_bytes,
                    format("a row of tiles of a picture {} pixels wide, in {} precision,",
                           std::min(shape.width, columns * kTileSide), to_text(precision)),
                    format("use a device with more memory, {}or the reference",
                           precision == Precision::single_ ? "" : "single precision, "),
                    {Setting::precision, Setting::renderer});
  }
  const std::uint64_t max_rows =
      std::max<std::uint64_t>(1, std::min(device.largest_allocation_bytes, max_bytes) / row_bytes);
  const std::uint64_t band_count = (rows + max_rows - 1) / max_rows;
  const auto band_rows = static_cast<std::uint32_t>((rows + band_count - 1) / band_count);
  const std::uint32_t first_column = left * kTileSide;
  const std::uint32_t width = std::min(columns * kTileSide, shape.width - first_column);
  std::vector<Band> bands;
  for (std::uint32_t row = top; row < top + rows; row += band_rows) {
    const std::uint32_t count = std::min(band_rows, top + rows - row);
    const std::uint32_t first_row = row * kTileSide;
    const std::uint32_t height = std::min(count * kTileSide, shape.height - first_row);
    bands.push_back(
        {std::uint64_t{row} * grid.columns() + left,
         std::uint64_t{count} * columns,
         columns,
         grid.columns() - columns,
         first_row,
         first_column,
         {width, height, shape.channels},
         std::accumulate(sum_tiles.begin() + (row - top), sum_tiles.begin() + (row - top + count), std::uint64_t{0})});
  }
  return bands;
}

TableNumbers TableNumbers::of(Precision precision) { return {weight_bytes(precision), precision != Precision::fixed}; }

std::vector<TableSlice> cut_tables(const RenderPlan& plan, const TableNumbers& numbers, const DeviceInfo& device,
                                   std::uint64_t max_bytes) {
  const std::uint64_t row_bytes = plan.function_count() * numbers.levels * numbers.bytes;
  // Spans never decide: a block has one row of them, no wider than its rows of weights, of which it has two or more.
  const std::uint64_t max_blocks = device.largest_allocation_bytes / sizeof(BlockEntry);
  // Kernels count the elements of a block's tables in 32 bits.
  const std::uint64_t max_bytes_of_block =
      std::min(device.largest_allocation_bytes, std::uint64_t{0xFFFF'FFFF} * numbers.bytes);
  const auto fits = [&](std::uint64_t rows) {
    return align_up(rows, WorkShape::kMaxTableRows) * row_bytes <= max_bytes_of_block;
  };
  std::vector<TableSlice> slices;
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const PlannedBlock& block = plan.blocks[b];
    const std::uint64_t last_row = block.table_row + block.row_count();
    const bool is_corrected = numbers.has_corrections && plan.is_corrected(block);
    const std::uint64_t rows = (is_corrected ? 2 : 1) * block.row_count();
    if (!fits(rows)) {
      throw too_large(
          device, rows * row_bytes,
          format("a table of {} functions for a block of {} samples", plan.function_count(), block.extent.sample_count),
          "use fewer functions at a time, or encode with fewer samples a block", {Setting::block_samples});
    }
    if (slices.empty() || !fits(slices.back().row_count() + rows) ||
        (slices.back().row_count() + rows) * row_bytes > max_bytes || b - slices.back().first_block == max_blocks) {
      slices.push_back({b, b, block.table_row, block.table_row});
    }
    slices.back().last_block = b + 1;
    slices.back().last_row = last_row;
    if (!is_corrected) continue;
    slices.back().corrected.push_back(b);
    slices.back().corrected_rows += block.row_count();
  }
  return slices;
}

DeviceError too_large(const DeviceInfo& device, std::uint64_t bytes, std::string_view what, std::string_view way_out,
                      std::vector<Setting> settings) {
  const auto megabytes = [](std::uint64_t size) { return static_cast<double>(size) * 1e-6; };
  return DeviceError(format("{} takes {:.1f} MB and {} allocates at most {:.1f} MB at a time; {}", what,
                            megabytes(bytes), device.name, megabytes(device.largest_allocation_bytes), way_out),
                     std::move(settings));
}

}  // namespace nutik
