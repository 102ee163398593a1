#include "opencl/device_tables.hpp"

#include <algorithm>

#include "render/fixed_scale.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// From how many numbers on several threads pack them.
constexpr std::uint64_t kManyNumbers = 1u << 17;

std::vector<SampleSpan> spans_of(const GainTable& table, const RenderPlan& plan, const TableSlice& slice) {
  std::vector<SampleSpan> spans;
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b) {
    spans.push_back(table.span_in(plan.blocks[b].extent));
  }
  return spans;
}

bool is_of(const std::vector<std::uint64_t>& blocks, const RenderPlan& plan, const TableSlice& slice) {
  return std::equal(blocks.begin(), blocks.end(),
                    plan.blocks.begin() + static_cast<std::ptrdiff_t>(slice.first_block),
                    plan.blocks.begin() + static_cast<std::ptrdiff_t>(slice.last_block),
                    [](std::uint64_t block, const PlannedBlock& planned) { return block == planned.block; });
}

}  // namespace

std::uint64_t DeviceTables::Slice::bytes() const {
  return columns.size() * (2 * row_count * weight_bytes(precision) + blocks.size() * sizeof(SampleSpan));
}

SliceTables DeviceTables::slice(const RenderPlan& plan, const TableSlice& slice, Precision precision,
                                DeviceMemory& memory, std::uint64_t& written_bytes) {
  Slice& kept = slice_for(plan, slice, precision, memory);
  const FixedScale scale = precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
  std::vector<std::size_t> stale;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    Column column{plan.functions[f].table, scale.exponents.empty() ? 0 : scale.exponents[f]};
    if (kept.columns[f] == column) continue;
    kept.columns[f] = {};  // until it is written
    stale.push_back(f);
  }
  if (stale.empty()) return kept.tables;
  // Columns are written with gaps, which a device may do slowly.
  const bool is_mostly_stale = 4 * stale.size() > kept.columns.size();
  if (is_mostly_stale) {
    write_all(plan, slice, kept);
  } else {
    for (const std::size_t f : stale) write_column(plan, slice, f, kept);
  }
  for (const std::size_t f : stale) {
    kept.columns[f] = {plan.functions[f].table, scale.exponents.empty() ? 0 : scale.exponents[f]};
  }
  written_bytes +=
      kept.bytes() / kept.columns.size() * (is_mostly_stale ? kept.columns.size() : stale.size());
  return kept.tables;
}

DeviceTables::Slice& DeviceTables::slice_for(const RenderPlan& plan, const TableSlice& slice,
                                             Precision precision, DeviceMemory& memory) {
  const std::uint64_t functions = plan.function_count();
  Slice* const kept = recent_.find([&](const Slice& each) {
    return each.precision == precision && each.columns.size() == functions && is_of(each.blocks, plan, slice);
  });
  if (kept != nullptr) {
    memory.count(kept->bytes());
    return *kept;
  }
  Slice made{precision, {}, slice.last_row - slice.first_row, {}, {}};
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b)
    made.blocks.push_back(plan.blocks[b].block);
  made.columns.resize(functions);
  const std::uint64_t bytes = made.row_count * functions * weight_bytes(precision);
  made.tables.weights = memory.allocate(bytes, CL_MEM_READ_ONLY);
  made.tables.boundaries = memory.allocate(bytes, CL_MEM_READ_ONLY);
  made.tables.spans = memory.allocate(made.blocks.size() * functions * sizeof(SampleSpan), CL_MEM_READ_ONLY);
  return recent_.keep(std::move(made));
}

void DeviceTables::write_all(const RenderPlan& plan, const TableSlice& slice, Slice& to) {
  const std::uint64_t functions = plan.function_count();
  const std::size_t number = weight_bytes(to.precision);
  const FixedScale scale = to.precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
  Bytes weights(to.row_count * functions * number), boundaries(weights.size());
  std::vector<SampleSpan> spans(to.blocks.size() * functions);
  const auto pack = [&](std::uint64_t f) {
    const GainTable& table = *plan.functions[f].table;
    pack_column(table, plan, slice, to.precision, scale.exponents.empty() ? 0 : scale.exponents[f],
                {weights.data() + f * number, boundaries.data() + f * number, functions * number});
    const std::vector<SampleSpan> of_function = spans_of(table, plan, slice);
    for (std::size_t b = 0; b < of_function.size(); ++b) spans[b * functions + f] = of_function[b];
  };
  if (to.row_count * functions >= kManyNumbers) {
    parallel_for(functions, pack);
  } else {
    for (std::uint64_t f = 0; f < functions; ++f) pack(f);
  }
  queue_.enqueueWriteBuffer(to.tables.weights, CL_TRUE, 0, weights.size(), weights.data());
  queue_.enqueueWriteBuffer(to.tables.boundaries, CL_TRUE, 0, boundaries.size(), boundaries.data());
  queue_.enqueueWriteBuffer(to.tables.spans, CL_TRUE, 0, spans.size() * sizeof(SampleSpan), spans.data());
}

void DeviceTables::write_column(const RenderPlan& plan, const TableSlice& slice, std::size_t function,
                                Slice& to) {
  const std::size_t number = weight_bytes(to.precision);
  const FixedScale scale = to.precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
  const GainTable& table = *plan.functions[function].table;
  Bytes weights(to.row_count * number), boundaries(weights.size());
  pack_column(table, plan, slice, to.precision, scale.exponents.empty() ? 0 : scale.exponents[function],
              {weights.data(), boundaries.data(), number});
  const std::vector<SampleSpan> spans = spans_of(table, plan, slice);
  const auto write = [&](const cl::Buffer& buffer, std::size_t element, std::uint64_t rows,
                         const void* from) {
    queue_.enqueueWriteBufferRect(buffer, CL_TRUE, {function * element, 0, 0}, {0, 0, 0}, {element, rows, 1},
                                  plan.function_count() * element, 0, element, 0, from);
  };
  write(to.tables.weights, number, to.row_count, weights.data());
  write(to.tables.boundaries, number, to.row_count, boundaries.data());
  write(to.tables.spans, sizeof(SampleSpan), to.blocks.size(), spans.data());
}

}  // namespace nutik
