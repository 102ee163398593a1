#include "opencl/gain_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

#include "capture/error.hpp"
#include "render/fixed_scale.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// Where the numbers of one function go: boundaries a row after another, `stride` bytes apart; weights in groups of
// rows, whose own lie side by side (kernels/row_groups.clh).
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

// A block's rows of one column, from `block_row` on: the numbers of the samples from `first` on, 0 and flat boundaries
// round them.
template <typename Number, typename Values, typename Convert>
void write_block(const Values& weights, const Values& boundaries, std::uint32_t first, std::uint32_t sample_count,
                 const TableColumn& column, std::uint64_t block_row, Convert convert) {
  const auto count = static_cast<std::uint32_t>(weights.size());
  const auto put = [](std::byte* to, const Number& number) { std::memcpy(to, &number, sizeof number); };
  for (std::uint32_t row = 0; row <= sample_count; ++row) {
    const std::uint32_t i = std::clamp(row, first, first + count) - first;
    const bool is_live = row >= first && i < count;
    put(column.weight(block_row + row), is_live ? convert(weights[i]) : Number{});
    put(column.boundary(block_row + row), boundaries.empty() ? Number{} : convert(boundaries[i]));
  }
}

// Where a plan sums light, all blocks are alike, each on its own.
SteadyGain steady_of(const GainTable& table, const RenderPlan& plan, const PlannedBlock& planned) {
  SteadyGain steady = table.steady_in(planned.block);
  if (plan.sums_light) steady.bundle = {planned.block, 1, *plan.sums_light};
  return steady;
}

// 1, that sums of what is not steady are multiplied by.
Bytes one_in(Precision precision) {
  if (precision != Precision::fixed) return numbers_of(std::array{1.0}, precision);
  Bytes one(weight_bytes(precision));
  constexpr std::uint64_t kOne = 1;
  std::memcpy(one.data(), &kOne, sizeof kOne);
  return one;
}

// From how many numbers on several threads pack them.
constexpr std::uint64_t kManyNumbers = 1u << 17;

bool is_of(const std::vector<std::uint64_t>& blocks, const RenderPlan& plan, const TableSlice& slice) {
  return std::equal(blocks.begin(), blocks.end(), plan.blocks.begin() + static_cast<std::ptrdiff_t>(slice.first_block),
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

// Writes a function's numbers for the rows of a slice, every byte of them: in steady blocks those of light · ns, unless
// numbers are whole. `exponent` is the function's of FixedScale, for whole numbers.
void pack_column(const GainTable& table, const RenderPlan& plan, const TableSlice& slice, Precision precision,
                 int exponent, const TableColumn& column) {
  GainTable::Reader reader(table);
  const auto write = [&](std::uint64_t row, std::uint32_t samples, std::span<const double> weights,
                         std::span<const double> boundaries, std::uint32_t first) {
    switch (precision) {
      case Precision::single_:
        write_block<float>(weights, boundaries, first, samples, column, row,
                           [](double number) { return static_cast<float>(number); });
        break;
      case Precision::compensated:
        write_block<FloatPair>(weights, boundaries, first, samples, column, row, pair_of);
        break;
      case Precision::double_:
      case Precision::fixed:
        write_block<double>(weights, boundaries, first, samples, column, row, std::identity{});
        break;
    }
  };
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b) {
    const PlannedBlock& planned = plan.blocks[b];
    const std::uint32_t samples = planned.extent.sample_count;
    const std::uint64_t row = planned.table_row - slice.first_row;
    if (precision == Precision::fixed) {
      const BlockTable from = reader.block(planned.block);
      const FixedBlock whole = fixed_block(from, exponent);
      write_block<std::int64_t>(whole.weights, whole.boundaries, from.span.first, samples, column, row,
                                std::identity{});
    } else if (const SteadyGain steady = steady_of(table, plan, planned); steady.is_steady()) {
      const HatNumbers hats = hats_of(planned.extent, plan.layout->timeline, steady.bundle.halves);
      write(row, samples, hats.weights, hats.boundaries, hats.span.first);
    } else {
      const BlockTable from = reader.block(planned.block);
      write(row, samples, from.weights, from.boundaries, from.span.first);
    }
  }
  std::uint64_t row = slice.last_row - slice.first_row;
  for (const std::size_t b : slice.corrected) {
    const PlannedBlock& planned = plan.blocks[b];
    const SteadyGain steady = table.steady_in(planned.block);
    CorrectionNumbers correction;
    if (!steady.corrected.empty()) {
      const BlockTable from = reader.block(planned.block);
      const HatNumbers hats = hats_of(planned.extent, plan.layout->timeline, steady.bundle.halves);
      correction = correction_of(steady, hats, from.span, from.weights);
    }
    write(row, planned.extent.sample_count, correction.weights, correction.boundaries, steady.corrected.first);
    row += planned.row_count();
  }
}

// What a function makes of the blocks of a slice, and the gains of those that are steady, 1 of all others.
struct PartColumn {
  std::vector<BlockPart> parts;
  Bytes gains;
};
PartColumn part_column(const GainTable& table, const RenderPlan& plan, const TableSlice& slice, Precision precision) {
  PartColumn column;
  const Bytes one = one_in(precision);
  const auto add = [&](const BlockPart& part, const Bytes& gain) {
    column.parts.push_back(part);
    column.gains.insert(column.gains.end(), gain.begin(), gain.end());
  };
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b) {
    const PlannedBlock& planned = plan.blocks[b];
    const SteadyGain steady = precision == Precision::fixed ? SteadyGain{} : steady_of(table, plan, planned);
    if (!steady.is_steady()) {
      add({table.span_in(planned.extent), 0}, one);
      continue;
    }
    BlockPart part{samples_of(steady.bundle.halves, planned.extent),
                   BlockPart::kSteady | steady.bundle.index() << BlockPart::kSumShift};
    if (steady.bundle.is_bundle()) {
      part.bits |= BlockPart::kInBundle;
      if (planned.block == steady.bundle.first) part.bits |= BlockPart::kBundleStart;
      if (planned.block == steady.bundle.last()) part.bits |= BlockPart::kBundleEnd;
    }
    add(part, plan.sums_light ? one : numbers_of(std::array{steady.per_ns}, precision));
  }
  for (const std::size_t b : slice.corrected) add({table.steady_in(plan.blocks[b].block).corrected, 0}, one);
  return column;
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

std::uint64_t GainColumns::Slice::bytes() const {
  return columns.size() * ((weight_rows() + row_count) * weight_bytes(precision) +
                           part_count() * (sizeof(BlockPart) + weight_bytes(precision)));
}

SliceTables GainColumns::slice(const RenderPlan& plan, const TableSlice& slice, Precision precision,
                               std::uint32_t group_rows, DeviceMemory& memory, std::uint64_t& written_bytes,
                               const std::stop_token& stop) {
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
    write_all(plan, slice, wanted, kept, stop);
    written_bytes += kept.bytes();
  } else {
    for (const std::size_t f : stale) write_column(plan, slice, f, wanted[f], kept);
    written_bytes += stale.size() * column_bytes;
  }
  kept.columns = std::move(wanted);
  return kept.tables;
}

GainColumns::Slice& GainColumns::slice_for(const RenderPlan& plan, const TableSlice& slice, Precision precision,
                                           std::uint32_t group_rows, DeviceMemory& memory) {
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
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b) made.blocks.push_back(plan.blocks[b].block);
  made.columns.resize(functions);
  const std::uint64_t row_bytes = functions * weight_bytes(precision);
  made.tables.weights = memory.allocate(made.weight_rows() * row_bytes, CL_MEM_READ_ONLY);
  made.tables.boundaries = memory.allocate(row_count * row_bytes, CL_MEM_READ_ONLY);
  made.tables.parts = memory.allocate(made.part_count() * functions * sizeof(BlockPart), CL_MEM_READ_ONLY);
  made.tables.gains = memory.allocate(made.part_count() * functions * weight_bytes(precision), CL_MEM_READ_ONLY);
  return recent_.keep(std::move(made));
}

void GainColumns::write_all(const RenderPlan& plan, const TableSlice& slice, std::span<const TableColumnSource> columns,
                            Slice& to, const std::stop_token& stop) {
  const std::uint64_t functions = plan.function_count();
  const std::size_t number = weight_bytes(to.precision);
  Bytes weights(to.weight_rows() * functions * number), boundaries(to.row_count * functions * number);
  std::vector<BlockPart> parts(to.part_count() * functions);
  Bytes gains(parts.size() * number);
  const auto pack = [&](std::uint64_t f) {
    if (stop.stop_requested()) throw Cancelled();
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

void GainColumns::write_column(const RenderPlan& plan, const TableSlice& slice, std::size_t function,
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
