// The tables of gain functions that kernels read, on the device from one exposure to the next.
//
//   in:      a plan, a slice of it, an arithmetic
//   out:     buffers of weights in groups of rows (kernels/row_groups.clh), of boundaries [row][function], of parts and
//            gains [block][function], corrections last
//   always:  what a buffer holds already is not written again: a function that changed costs its own column
//
// Rows of functions side by side suit pixels that have many functions among them
// (docs/explanation/performance.md): a column is therefore written with gaps, by a rectangular copy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "opencl/allocation_cuts.hpp"
#include "opencl/device_memory.hpp"
#include "opencl/kernel_numbers.hpp"
#include "opencl/opencl_api.hpp"
#include "opencl/recent.hpp"

namespace nutik {

struct SliceTables {
  cl::Buffer weights;
  cl::Buffer boundaries;
  cl::Buffer parts;
  cl::Buffer gains;
  std::uint32_t gain_rows = 0;  // of each level of a SampleCombiner's
};

// What the numbers of a function were made from: where it is the same, so are they, and sums of them.
struct TableColumnSource {
  std::shared_ptr<const GainTable> table;
  int exponent = 0;    // of whole numbers,
  int light_bits = 0;  // and of their light
  friend bool operator==(const TableColumnSource&, const TableColumnSource&) = default;
};
// By function of a plan.
[[nodiscard]] std::vector<TableColumnSource> column_sources(const RenderPlan& plan, Precision precision);

class GainColumns {
 public:
  // `max_bytes` are kept; a slice that is in use counts as one of them.
  GainColumns(cl::CommandQueue queue, std::uint64_t max_bytes) : queue_(std::move(queue)), recent_(max_bytes) {}

  // A slice's tables, which no kernel may read any more when the next slice is asked for. What it takes is counted in
  // `memory`, what had to be written is added to `written_bytes`. Throws Cancelled at a stop.
  [[nodiscard]] SliceTables slice(const RenderPlan& plan, const TableSlice& slice, Precision precision,
                                  std::uint32_t group_rows, DeviceMemory& memory, std::uint64_t& written_bytes,
                                  const std::stop_token& stop);

 private:
  struct Slice {
    Precision precision;
    std::uint32_t group_rows;
    std::vector<std::uint64_t> blocks;   // of the capture
    std::vector<std::size_t> corrected;  // planned blocks
    std::uint64_t row_count;
    std::vector<TableColumnSource> columns;
    SliceTables tables;

    // Blocks and corrections.
    [[nodiscard]] std::size_t part_count() const { return blocks.size() + corrected.size(); }
    // In whole groups.
    [[nodiscard]] std::uint64_t weight_rows() const { return align_up(row_count, group_rows); }
    [[nodiscard]] std::uint64_t bytes() const;
  };

  Slice& slice_for(const RenderPlan& plan, const TableSlice& slice, Precision precision, std::uint32_t group_rows,
                   DeviceMemory& memory);
  void write_all(const RenderPlan& plan, const TableSlice& slice, std::span<const TableColumnSource> columns, Slice& to,
                 const std::stop_token& stop);
  void write_column(const RenderPlan& plan, const TableSlice& slice, std::size_t function,
                    const TableColumnSource& column, Slice& to);

  cl::CommandQueue queue_;
  Recent<Slice> recent_;
};

}  // namespace nutik
