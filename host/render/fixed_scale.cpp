#include "render/fixed_scale.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nutik {
namespace {

constexpr int kSumBits = 62;  // of a sum's magnitude, which 63 could hold

// Calls visit(row) for the rows of a function's live samples, in time order. Weights elsewhere are 0.
template <typename Visit>
void for_each_live_row(const RenderPlan& plan, std::size_t function, Visit visit) {
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const SampleSpan& span = plan.spans[b * plan.function_count() + function];
    for (std::uint32_t k = span.first; k < span.last; ++k) visit(plan.blocks[b].table_row + k);
  }
}

struct Weights {
  std::uint64_t count = 0;  // that are not 0
  double magnitude = 0.0;   // Σ|w|
};

Weights measure(const RenderPlan& plan, std::size_t function) {
  Weights weights;
  CompensatedSum magnitude;
  for_each_live_row(plan, function, [&](std::uint64_t row) {
    const double weight = plan.weights[row * plan.function_count() + function];
    weights.count += weight != 0.0;
    magnitude.add(std::fabs(weight));
  });
  weights.magnitude = magnitude.value();
  return weights;
}

}  // namespace

double FixedScale::light_factor(std::size_t function) const {
  return std::scalbn(1.0, -exponents[function]) / static_cast<double>(white_light);
}

FixedScale fixed_scale(const RenderPlan& plan) {
  std::vector<Weights> measured;
  std::uint64_t most = 1;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    measured.push_back(measure(plan, f));
    most = std::max(most, measured.back().count);
  }
  FixedScale scale;
  if (plan.capture.transfer.is_linear()) {
    scale.white_light = plan.capture.white_code;
    scale.light_bits = static_cast<int>(std::bit_width(scale.white_light));
  } else {
    // Light errs by half of 2^-bits, a sum of n weights by n/2 of 2^(bits - 62): alike where bits is this.
    scale.light_bits = (kSumBits - static_cast<int>(std::bit_width(most))) / 2;
    scale.white_light = std::uint64_t{1} << scale.light_bits;
  }
  for (const Weights& weights : measured) {
    // Whole weights add up to 2^e Σ|w| + count at most: each is off by less than 1.
    const double room = std::scalbn(1.0, kSumBits - scale.light_bits) - static_cast<double>(weights.count);
    scale.exponents.push_back(weights.magnitude > 0.0 ? std::ilogb(room / (weights.magnitude * (1 + 0x1p-40)))
                                                      : 0);
  }
  return scale;
}

FixedSweep::FixedSweep(const RenderPlan& plan, const FixedScale& scale)
    : plan_(plan), exponents_(scale.exponents), boundaries_(plan.functions.size()) {}

FixedTables FixedSweep::pack(std::size_t last_block) {
  const std::uint64_t count = plan_.function_count();
  FixedTables tables;
  if (next_block_ == last_block) return tables;
  const std::uint64_t first_row = plan_.blocks[next_block_].table_row;
  const PlannedBlock& last = plan_.blocks[last_block - 1];
  tables.weights.assign((last.table_row + last.row_count() - first_row) * count, 0);
  tables.boundaries = tables.weights;
  for (; next_block_ < last_block; ++next_block_) {
    const PlannedBlock& block = plan_.blocks[next_block_];
    const std::uint64_t begin = (block.table_row - first_row) * count;
    for (std::size_t f = 0; f < count; ++f) {
      Boundary& boundary = boundaries_[f];
      const std::int64_t start = boundary.rounded;
      for (std::uint64_t k = 0; k < block.extent.sample_count; ++k) {
        const std::uint64_t at = begin + k * count + f;
        tables.boundaries[at] = boundary.rounded - start;
        const double weight = plan_.weights[(block.table_row + k) * count + f];
        if (weight == 0.0) continue;
        boundary.exact.add(weight);
        const std::int64_t next = std::llrint(std::scalbn(boundary.exact.value(), exponents_[f]));
        tables.weights[at] = next - boundary.rounded;
        boundary.rounded = next;
      }
      tables.boundaries[begin + block.extent.sample_count * count + f] = boundary.rounded - start;
    }
  }
  return tables;
}

}  // namespace nutik
