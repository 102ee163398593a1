#include "opencl/render_memory.hpp"

#include <algorithm>

#include "imev/tile.hpp"
#include "opencl/kernel_numbers.hpp"
#include "opencl/work_shape.hpp"
#include "render/picture_memory.hpp"

namespace nutik {
namespace {

// Large enough that launching costs nothing, small enough that reading the next one hides behind it.
constexpr std::uint64_t kChunkBytes = 64ull << 20;

// A row of tables: weights and boundaries on the device, as many while they are packed, and what they are packed from.
std::uint64_t row_bytes(const RenderPlan& plan, Precision precision) {
  return plan.function_count() * (4 * weight_bytes(precision) + 2 * sizeof(double));
}

}  // namespace

RenderMemory memory_for_blocks(std::uint64_t memory_bytes) {
  const std::uint64_t chunk_bytes = std::min(kChunkBytes, memory_bytes / 4);
  // What chunks leave of their half. Pictures to be seen and pictures to be kept may take two arithmetics.
  const std::uint64_t rest = memory_bytes / 2 - 2 * chunk_bytes;
  return {{chunk_bytes, memory_bytes / 2, true}, rest / 6, rest / 8, memory_bytes / 32};
}

LeastMemory least_memory(const RenderPlan& plan, const CaptureSource& source, const Shape& picture,
                         ValueType type, Precision precision) {
  LeastMemory least;
  std::uint64_t block_rows = 0;
  for (const PlannedBlock& planned : plan.blocks) {
    least.block_bytes = std::max(least.block_bytes, align_up(source.lent_bytes(planned.block), kBlockAlignment));
    block_rows = std::max(block_rows, planned.row_count());
  }
  const bool has_bundles = precision != Precision::fixed && plan.has_bundles();
  MemoryNeeds& needs = least.needs;
  needs = picture_needs(picture, type, (has_bundles ? 2 : 1) * sum_bytes(precision));
  if (const MaskMap& map = *plan.map; !map.mixed.empty()) {
    // Sums of a tile for each of its functions but one, which counts above, on the device and where they are blended;
    // functions and shares of pixels here and there.
    const std::uint64_t map_bytes =
        2 * ((map.has_delays() ? sizeof(std::uint16_t) : 1) + sizeof(std::uint16_t)) * kTilePixels;
    const std::uint64_t tiles = TileGrid(plan.capture.shape).tile_count();
    std::uint64_t more_tiles = 0;
    for (const MixedTile& tile : map.mixed_tiles) more_tiles += tile.tags.size() - 1;
    const std::uint64_t tile_sums = std::uint64_t{picture.channels} * kTilePixels * sum_bytes(precision);
    needs.add("shares of functions", more_tiles * 2 * tile_sums + (tiles + more_tiles) * map_bytes);
  }
  if (plan.map->has_delays()) {
    constexpr std::uint64_t kFunctionBytes = 1024;  // as it is planned, with its table's head
    std::uint64_t points = 0;
    for (const PlannedFunction& function : plan.functions) points += function.function.points().size();
    needs.add("delays", 2 * plan.map->bytes() + plan.function_count() * kFunctionBytes +
                            2 * points * sizeof(ControlPoint));
  }
  const bool has_corrected = precision != Precision::fixed && plan.has_corrected();
  least.table_bytes = (has_corrected ? 2 : 1) * block_rows * row_bytes(plan, precision);
  // Weights are there in whole groups of rows, on the device and while they are packed.
  const std::uint64_t last_group_bytes =
      2 * (WorkShape::kMaxTableRows - 1) * plan.function_count() * weight_bytes(precision);
  needs.add("gain tables of a block", least.table_bytes + last_group_bytes);
  needs.add("a block", least.block_bytes);
  return least;
}

RenderMemory memory_for_render(std::uint64_t allowed, const RenderPlan& plan, const CaptureSource& source,
                               const Shape& picture, ValueType type, Precision precision) {
  const auto [needs, block_bytes, min_tables] = least_memory(plan, source, picture, type, precision);
  std::uint64_t rest = needs.rest_of(allowed);

  const std::uint64_t all_tables = std::max(plan.row_count() * row_bytes(plan, precision), min_tables);
  const std::uint64_t more_tables = std::min(all_tables - min_tables, rest / 4);
  rest -= more_tables;
  RenderMemory memory;
  memory.slice_bytes = (min_tables + more_tables) / row_bytes(plan, precision) * plan.function_count() *
                       weight_bytes(precision);
  const std::uint64_t blocks = block_bytes + rest;
  memory.feed.reads_ahead = blocks >= 2 * block_bytes;
  memory.feed.chunk_bytes = std::min(kChunkBytes, blocks / 4);
  const std::uint64_t passing =
      (memory.feed.reads_ahead ? 2 : 1) * std::max(block_bytes, memory.feed.chunk_bytes);
  memory.feed.resident_bytes = blocks - std::min(blocks, passing);
  memory.kept_bytes = memory.feed.resident_bytes / 8;
  memory.held_bytes = memory.feed.resident_bytes / 8;
  memory.feed.resident_bytes -= 2 * memory.kept_bytes + memory.held_bytes;
  return memory;
}

std::vector<std::uint64_t> memory_of_bands(std::uint64_t allowed, const RenderPlan& plan,
                                           const CaptureSource& source, std::span<const Rectangle> bands,
                                           ValueType type, Precision precision) {
  std::vector<std::uint64_t> shares(bands.size(), 0);
  if (allowed == 0) return shares;
  const std::uint32_t channels = plan.capture.shape.channels;
  const auto least_of = [&](std::uint32_t width, std::uint32_t height) {
    return least_memory(plan, source, {width, height, channels}, type, precision).needs;
  };
  // What a band takes grows with its rows of tiles, ever more slowly: together they take most where all are equal.
  const Rectangle& first = bands.front();
  const std::uint32_t end = bands.back().y + bands.back().height;
  const std::uint64_t rows = (std::uint64_t{end} + kTileSide - 1) / kTileSide - first.y / kTileSide;
  const std::uint64_t rows_of_each = (rows + bands.size() - 1) / bands.size();
  const MemoryNeeds equal = least_of(first.width, static_cast<std::uint32_t>(rows_of_each * kTileSide));
  MemoryNeeds most;
  for (const MemoryPart& part : equal.parts()) most.add(part.what, part.bytes * bands.size());
  most.add("the picture", std::uint64_t{end - first.y} * first.width * channels * value_bytes(type));
  const std::uint64_t share_of_rest = most.rest_of(allowed) / bands.size();
  for (std::size_t i = 0; i < bands.size(); ++i)
    shares[i] = least_of(first.width, bands[i].height).bytes() + share_of_rest;
  return shares;
}

}  // namespace nutik
