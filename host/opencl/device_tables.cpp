#include "opencl/device_tables.hpp"

#include <algorithm>
#include <cstring>

#include "render/fixed_scale.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// From how many numbers on several threads pack them.
constexpr std::uint64_t kManyNumbers = 1u << 17;

bool is_of(const std::vector<std::uint64_t>& blocks, const RenderPlan& plan, const TableSlice& slice) {
  return std::equal(blocks.begin(), blocks.end(),
                    plan.blocks.begin() + static_cast<std::ptrdiff_t>(slice.first_block),
                    plan.blocks.begin() + static_cast<std::ptrdiff_t>(slice.last_block),
                    [](std::uint64_t block, const PlannedBlock& planned) { return block == planned.block; });
}

// Enqueues writes, only the last of which is waited for. Where one fails, those before it are waited for as well: they
// read memory that is let go then.
template <typename Writes>
void write_in_order(const cl::CommandQueue& queue, Writes writes) {
  try {
    writes();
  } catch (const cl::Error&) {
    clFinish(queue());
    throw;
  }
}

}  // namespace

std::vector<TableColumnSource> column_sources(const RenderPlan& plan, Precision precision) {
  std::vector<TableColumnSource> columns;
  for (const PlannedFunction& function : plan.functions) columns.push_back({function.table, 0, 0});
  if (precision == Precision::fixed) {
    const FixedScale scale = fixed_scale(plan);
    for (std::size_t f = 0; f < columns.size(); ++f) {
      columns[f].exponent = scale.exponents[f];
      columns[f].light_bits = scale.light_bits;
    }
  }
  return columns;
}

std::uint64_t DeviceTables::Slice::bytes() const {
  return columns.size() * ((weight_rows() + row_count) * weight_bytes(precision) +
                           part_count() * (sizeof(BlockPart) + weight_bytes(precision)));
}

SliceTables DeviceTables::slice(const RenderPlan& plan, const TableSlice& slice, Precision precision,
                                std::uint32_t group_rows, DeviceMemory& memory, std::uint64_t& written_bytes) {
  Slice& kept = slice_for(plan, slice, precision, group_rows, memory);
  std::vector<TableColumnSource> wanted = column_sources(plan, precision);
  std::vector<std::size_t> stale;
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    if (kept.columns[f] != wanted[f]) stale.push_back(f);
  }
  if (stale.empty()) return kept.tables;
  for (const std::size_t f : stale) kept.columns[f] = {};  // until they are written
  const std::uint64_t column_bytes = kept.bytes() / wanted.size();
  // Columns are written with gaps, which a device may do slowly.
  if (4 * stale.size() > wanted.size()) {
    write_all(plan, slice, wanted, kept);
    written_bytes += kept.bytes();
  } else {
    for (const std::size_t f : stale) write_column(plan, slice, f, wanted[f], kept);
    written_bytes += stale.size() * column_bytes;
  }
  kept.columns = std::move(wanted);
  return kept.tables;
}

DeviceTables::Slice& DeviceTables::slice_for(const RenderPlan& plan, const TableSlice& slice,
                                             Precision precision, std::uint32_t group_rows,
                                             DeviceMemory& memory) {
  const std::uint64_t functions = plan.function_count();
  const std::uint64_t row_count = slice.row_count();
  Slice* const kept = recent_.find([&](const Slice& each) {
    return each.precision == precision && each.group_rows == group_rows && each.columns.size() == functions &&
           each.row_count == row_count && each.corrected == slice.corrected && is_of(each.blocks, plan, slice);
  });
  if (kept != nullptr) {
    memory.count(kept->bytes());
    return *kept;
  }
  Slice made{precision, group_rows, {}, slice.corrected, row_count, {}, {}};
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b)
    made.blocks.push_back(plan.blocks[b].block);
  made.columns.resize(functions);
  const std::uint64_t row_bytes = functions * weight_bytes(precision);
  made.tables.weights = memory.allocate(made.weight_rows() * row_bytes, CL_MEM_READ_ONLY);
  made.tables.boundaries = memory.allocate(row_count * row_bytes, CL_MEM_READ_ONLY);
  made.tables.parts = memory.allocate(made.part_count() * functions * sizeof(BlockPart), CL_MEM_READ_ONLY);
  made.tables.gains =
      memory.allocate(made.part_count() * functions * weight_bytes(precision), CL_MEM_READ_ONLY);
  return recent_.keep(std::move(made));
}

void DeviceTables::write_all(const RenderPlan& plan, const TableSlice& slice,
                             std::span<const TableColumnSource> columns, Slice& to) {
  const std::uint64_t functions = plan.function_count();
  const std::size_t number = weight_bytes(to.precision);
  Bytes weights(to.weight_rows() * functions * number), boundaries(to.row_count * functions * number);
  std::vector<BlockPart> parts(to.part_count() * functions);
  Bytes gains(parts.size() * number);
  const auto pack = [&](std::uint64_t f) {
    pack_column(*columns[f].table, plan, slice, to.precision, columns[f].exponent,
                {weights.data() + f * to.group_rows * number, boundaries.data() + f * number, functions * number,
                 number, to.group_rows});
    const PartColumn of_function = part_column(*columns[f].table, plan, slice, to.precision);
    for (std::size_t b = 0; b < of_function.parts.size(); ++b) {
      parts[b * functions + f] = of_function.parts[b];
      std::memcpy(gains.data() + (b * functions + f) * number, of_function.gains.data() + b * number, number);
    }
  };
  if (to.row_count * functions >= kManyNumbers) {
    parallel_for(functions, pack);
  } else {
    for (std::uint64_t f = 0; f < functions; ++f) pack(f);
  }
  write_in_order(queue_, [&] {
    queue_.enqueueWriteBuffer(to.tables.weights, CL_FALSE, 0, weights.size(), weights.data());
    queue_.enqueueWriteBuffer(to.tables.boundaries, CL_FALSE, 0, boundaries.size(), boundaries.data());
    queue_.enqueueWriteBuffer(to.tables.gains, CL_FALSE, 0, gains.size(), gains.data());
    queue_.enqueueWriteBuffer(to.tables.parts, CL_TRUE, 0, parts.size() * sizeof(BlockPart), parts.data());
  });
}

void DeviceTables::write_column(const RenderPlan& plan, const TableSlice& slice, std::size_t function,
                                const TableColumnSource& column, Slice& to) {
  const std::size_t number = weight_bytes(to.precision);
  Bytes weights(to.weight_rows() * number), boundaries(to.row_count * number);
  pack_column(*column.table, plan, slice, to.precision, column.exponent,
              {weights.data(), boundaries.data(), number, number, to.group_rows});
  const PartColumn of_function = part_column(*column.table, plan, slice, to.precision);
  const auto write = [&](const cl::Buffer& buffer, std::size_t element, std::uint64_t rows, const void* from,
                         bool waits) {
    queue_.enqueueWriteBufferRect(buffer, waits ? CL_TRUE : CL_FALSE, {function * element, 0, 0}, {0, 0, 0},
                                  {element, rows, 1}, plan.function_count() * element, 0, element, 0, from);
  };
  write_in_order(queue_, [&] {
    write(to.tables.weights, to.group_rows * number, to.weight_rows() / to.group_rows, weights.data(), false);
    write(to.tables.boundaries, number, to.row_count, boundaries.data(), false);
    write(to.tables.gains, number, to.part_count(), of_function.gains.data(), false);
    write(to.tables.parts, sizeof(BlockPart), to.part_count(), of_function.parts.data(), true);
  });
}

}  // namespace nutik
