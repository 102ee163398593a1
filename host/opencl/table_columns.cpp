#include "opencl/table_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

#include "render/fixed_scale.hpp"

namespace nutik {
namespace {

// A block's rows of one column, from `block_row` on: the numbers of the samples from `first` on, 0 and flat boundaries
// round them.
template <typename Number, typename Values, typename Convert>
void write_block(const Values& weights, const Values& boundaries, std::uint32_t first,
                 std::uint32_t sample_count, const TableColumn& column, std::uint64_t block_row, Convert convert) {
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

}  // namespace

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
    write(row, planned.extent.sample_count, correction.weights, correction.boundaries,
          steady.corrected.first);
    row += planned.row_count();
  }
}

PartColumn part_column(const GainTable& table, const RenderPlan& plan, const TableSlice& slice,
                       Precision precision) {
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
      part.steady |= BlockPart::kInBundle;
      if (planned.block == steady.bundle.first) part.steady |= BlockPart::kBundleStart;
      if (planned.block == steady.bundle.last()) part.steady |= BlockPart::kBundleEnd;
    }
    add(part, plan.sums_light ? one : numbers_of(std::array{steady.per_ns}, precision));
  }
  for (const std::size_t b : slice.corrected) add({table.steady_in(plan.blocks[b].block).corrected, 0}, one);
  return column;
}

}  // namespace nutik
