// How tiles of a block may be stored, and what reading them costs: TileLog chooses by it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "imev/block.hpp"

namespace nutik {

// `automatic` stores each tile the cheapest way to read; the others are for experiments: `dense` keeps a
// row for every sample, changed or not, `rows` and `records` use only that kind.
enum class TilePolicy { automatic, dense, rows, records };

std::string to_text(TilePolicy policy);

// What reading costs, in bytes of a row tile streamed by the kernel. A slot gathers a boundary value for
// every pixel where a row needs one for the whole tile; docs/explanation/performance.md has the measurement.
inline constexpr double kSlotCostPerByte = 2.5;

// Whether a tile whose samples have `rows` different rows, and whose busiest pixel has `slots` change
// records, is cheaper to read as records than as rows.
[[nodiscard]] inline bool records_are_cheaper(const BlockGeometry& geometry, std::uint32_t rows,
                                              std::uint32_t slots) {
  const double as_rows = static_cast<double>(geometry.rows_bytes(rows));
  const double as_records =
      static_cast<double>(geometry.row_bytes()) +
      kSlotCostPerByte * static_cast<double>(slots) * static_cast<double>(geometry.slot_bytes());
  return as_records < as_rows;
}

}  // namespace nutik
