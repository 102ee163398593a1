#include "opencl/table_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

#include "render/fixed_scale.hpp"

namespace nutik {
namespace {

// A block's rows of one column: the numbers of the samples from `first` on, 0 and flat boundaries round them.
template <typename Number, typename Values, typename Convert>
void write_block(const Values& weights, const Values& boundaries, std::uint32_t first,
                 std::uint32_t sample_count, const TableColumn& column, Convert convert) {
  const auto count = static_cast<std::uint32_t>(weights.size());
  const auto put = [&](std::byte* to, std::uint32_t row, const Number& number) {
    std::memcpy(to + row * column.stride, &number, sizeof number);
  };
  for (std::uint32_t row = 0; row <= sample_count; ++row) {
    const std::uint32_t i = std::clamp(row, first, first + count) - first;
    const bool is_live = row >= first && i < count;
    put(column.weights, row, is_live ? convert(weights[i]) : Number{});
    put(column.boundaries, row, boundaries.empty() ? Number{} : convert(boundaries[i]));
  }
}

// ∫φ of a block's samples in ns, and their sums from its first one on. All are whole halves of nanoseconds.
struct HatNumbers {
  std::vector<double> weights;
  std::vector<double> boundaries;
};

HatNumbers hats_of(const PlannedBlock& planned, const Timeline& timeline) {
  HatNumbers hats{{}, {0.0}};
  std::uint64_t halves = 0;
  for (const SampleTimes& sample : timeline.times(planned.extent.range())) {
    const auto exposed = static_cast<std::uint64_t>(sample.end_ns - sample.start_ns);
    const auto before = static_cast<std::uint64_t>(sample.start_ns - sample.before_ns);
    const auto after = static_cast<std::uint64_t>(sample.after_ns - sample.end_ns);
    const bool holds_to_the_end = sample.after_ns == timeline.duration_ns();
    const std::uint64_t hat = 2 * exposed + before + (holds_to_the_end ? 2 : 1) * after;
    halves += hat;
    hats.weights.push_back(static_cast<double>(hat) / 2);
    hats.boundaries.push_back(static_cast<double>(halves) / 2);
  }
  return hats;
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
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b) {
    const PlannedBlock& planned = plan.blocks[b];
    const std::uint32_t samples = planned.extent.sample_count;
    const std::size_t offset = (planned.table_row - slice.first_row) * column.stride;
    const TableColumn to{column.weights + offset, column.boundaries + offset, column.stride};
    const auto write = [&](std::span<const double> weights, std::span<const double> boundaries,
                           std::uint32_t first) {
      switch (precision) {
        case Precision::single_:
          write_block<float>(weights, boundaries, first, samples, to,
                             [](double number) { return static_cast<float>(number); });
          break;
        case Precision::compensated:
          write_block<FloatPair>(weights, boundaries, first, samples, to, pair_of);
          break;
        case Precision::double_:
        case Precision::fixed:
          write_block<double>(weights, boundaries, first, samples, to, std::identity{});
          break;
      }
    };
    if (precision == Precision::fixed) {
      const BlockTable from = reader.block(planned.block);
      const FixedBlock whole = fixed_block(from, exponent);
      write_block<std::int64_t>(whole.weights, whole.boundaries, from.span.first, samples, to,
                                std::identity{});
    } else if (table.steady_in(planned.block).is_steady()) {
      const HatNumbers hats = hats_of(planned, plan.layout->timeline);
      write(hats.weights, hats.boundaries, 0);
    } else {
      const BlockTable from = reader.block(planned.block);
      write(from.weights, from.boundaries, from.span.first);
    }
  }
}

PartColumn part_column(const GainTable& table, const RenderPlan& plan, const TableSlice& slice,
                       Precision precision) {
  PartColumn column;
  const Bytes one = one_in(precision);
  for (std::size_t b = slice.first_block; b < slice.last_block; ++b) {
    const PlannedBlock& planned = plan.blocks[b];
    const SteadyGain steady = precision == Precision::fixed ? SteadyGain{} : table.steady_in(planned.block);
    BlockPart part{table.span_in(planned.extent), steady.is_steady() ? BlockPart::kSteady : 0};
    if (steady.in_bundle && !plan.sums_light) {
      const std::uint64_t at = planned.block % kBundleBlocks;
      part.steady |= BlockPart::kInBundle | (at == 0 ? BlockPart::kBundleStart : 0) |
                     (at + 1 == kBundleBlocks ? BlockPart::kBundleEnd : 0);
    }
    column.parts.push_back(part);
    const Bytes gain =
        steady.is_steady() && !plan.sums_light ? numbers_of(std::array{steady.per_ns}, precision) : one;
    column.gains.insert(column.gains.end(), gain.begin(), gain.end());
  }
  return column;
}

}  // namespace nutik
