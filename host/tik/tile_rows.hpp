// Where the rows of a tile's body lie, as codecs go through them: in tiles of rows each row, in tiles of records the
// start and then each slot's codes, with their index in front.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "imev/block.hpp"

namespace nutik::tik {

// Consecutive tiles of a payload.
struct TileGroup {
  std::span<const TileEntry> entries;
  const BlockGeometry& geometry;
};

[[nodiscard]] inline std::uint32_t row_count(const TileEntry& entry) {
  return entry.is_records() ? entry.slots() + 1 : entry.rows();
}

// Offset of a slot within a records tile's body.
[[nodiscard]] inline std::uint64_t slot_offset(const BlockGeometry& geometry, std::uint32_t slot) {
  return geometry.row_bytes() + slot * geometry.slot_bytes();
}

// Offset of row r within a body.
[[nodiscard]] inline std::uint64_t row_offset(const TileEntry& entry, const BlockGeometry& geometry,
                                              std::uint32_t row) {
  if (!entry.is_records()) return geometry.row_index_bytes(entry.rows()) + row * geometry.row_bytes();
  if (row == 0) return 0;
  return slot_offset(geometry, row - 1) + kTilePixels * geometry.index_bytes();
}

}  // namespace nutik::tik
