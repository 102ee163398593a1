// The column of one function in the tables that kernels read (device_tables.hpp), packed for an arithmetic.
#pragma once

#include <cstddef>
#include <vector>

#include "opencl/kernel_tables.hpp"

namespace nutik {

// Where the numbers of one function go: boundaries a row after another, `stride` bytes apart; weights in groups of rows,
// whose own lie side by side (kernels/row_groups.clh).
struct TableColumn {
  std::byte* weights;
  std::byte* boundaries;
  std::size_t stride;
  std::size_t number_bytes;
  std::uint32_t group_rows;

  [[nodiscard]] std::byte* weight(std::uint64_t row) const {
    return weights + row / group_rows * group_rows * stride + row % group_rows * number_bytes;
  }
  [[nodiscard]] std::byte* boundary(std::uint64_t row) const { return boundaries + row * stride; }
};

// Writes a function's numbers for the rows of a slice, every byte of them: in steady blocks those of light · ns, unless
// numbers are whole. `exponent` is the function's of FixedScale, for whole numbers.
void pack_column(const GainTable& table, const RenderPlan& plan, const TableSlice& slice, Precision precision,
                 int exponent, const TableColumn& column);

// What a function makes of the blocks of a slice, and the gains of those that are steady, 1 of all others.
struct PartColumn {
  std::vector<BlockPart> parts;
  Bytes gains;
};
[[nodiscard]] PartColumn part_column(const GainTable& table, const RenderPlan& plan, const TableSlice& slice,
                                     Precision precision);

}  // namespace nutik
