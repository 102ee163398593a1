#include "opencl/work_shape.hpp"

#include <algorithm>
#include <limits>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/opencl_renderer.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kRoomForCopies = 32 << 10;  // of two groups, in any arithmetic

}  // namespace

WorkShape work_shape(const OpenClOptions& options, Precision precision, const DeviceInfo& device) {
  const bool is_of_words = precision == Precision::single_ || precision == Precision::fixed;  // a code's light
  WorkShape shape{4, 1, 4, 256, 4, is_of_words ? 16u : 8u};
  const bool has_vectors = device.native_float_lanes > 1;  // else its work-items are lanes, as on a GPU
  if (device.kind == DeviceKind::cpu && has_vectors) {
    const bool is_of_floats = precision == Precision::single_ || precision == Precision::compensated;
    shape = {kTilePixels, 16, is_of_floats ? 16u : 8u, 1};
  } else if (device.group_memory_bytes < kRoomForCopies) {
    shape.table_copies = 0;
  }
  if (options.item_pixels != 0) shape.item_pixels = options.item_pixels;
  if (options.item_tiles != 0) shape.item_tiles = options.item_tiles;
  if (options.lanes != 0) shape.lanes = options.lanes;
  if (options.group_items != 0) shape.group_items = options.group_items;
  if (options.rows_at_once != 0) shape.rows_at_once = options.rows_at_once;
  if (options.table_copies) shape.table_copies = *options.table_copies;
  const bool lanes_fit = shape.lanes == 1 || shape.lanes == 4 || shape.lanes == 8 || shape.lanes == 16;
  if (shape.item_pixels == 0 || kTilePixels % shape.item_pixels != 0 || !lanes_fit ||
      shape.item_pixels % shape.lanes != 0) {
    throw UsageError(format("{} pixels an item in {} lanes do not divide a tile of {}", shape.item_pixels,
                            shape.lanes, kTilePixels));
  }
  return shape;
}

std::uint64_t max_samples_a_launch(const DeviceInfo& device, const WorkShape& shape) {
  if (device.loop_limit == 0) return std::numeric_limits<std::uint64_t>::max();
  // If nothing is unrolled: a row, its channels and groups, and the coefficients of a curve for each of them.
  const std::uint64_t vectors = 3 * shape.item_pixels / shape.lanes;
  const std::uint64_t loops_a_sample = 2 + vectors * 12;
  return std::max<std::uint64_t>(1, device.loop_limit / loops_a_sample / shape.item_tiles);
}

}  // namespace nutik
