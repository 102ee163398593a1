#include "render/fixed_scale.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/function_course.hpp"

namespace nutik {
namespace {

constexpr int kSumBits = 62;  // of a sum's magnitude, which 63 could hold

}  // namespace

double FixedScale::light_factor(std::size_t function) const {
  return std::scalbn(1.0, -exponents[function]) / static_cast<double>(white_light);
}

FixedScale fixed_scale(const RenderPlan& plan) {
  std::uint64_t most = 1;
  for (const PlannedFunction& function : plan.functions) {
    most = std::max(most, function.table->course().weight_count);
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
  scale.blend_shift = kCodeBits - kBlendBits;
  for (const PlannedFunction& function : plan.functions) {
    const FunctionCourse& course = function.table->course();
    // Whole weights add up to 2^e Σ|w| + count at most: each is off by less than 1.
    const double room =
        std::scalbn(1.0, kSumBits - scale.light_bits) - static_cast<double>(course.weight_count);
    const double magnitude = course.compensated_magnitude;
    scale.exponents.push_back(magnitude > 0.0 ? std::ilogb(room / (magnitude * (1 + 0x1p-40))) : 0);
    // Rounded up, and once more for what whole weights add.
    const double largest = std::scalbn(course.magnitude, function.summary.exponent);
    const int bits = largest > 0.0 ? std::ilogb(largest) + 2 : 0;
    scale.blend_shift = std::clamp(bits + kCodeBits - kBlendBits, scale.blend_shift, kCodeBits - 1);
  }
  return scale;
}

FixedBlock fixed_block(const BlockTable& table, int exponent) {
  FixedBlock block;
  if (table.weights.empty()) return block;
  CompensatedSum exact = table.before;
  const auto rounded = [&] { return std::llrint(std::scalbn(exact.value(), exponent)); };
  const std::int64_t start = rounded();
  std::int64_t boundary = start;
  for (const double weight : table.weights) {
    block.boundaries.push_back(boundary - start);
    if (weight != 0.0) exact.add(weight);
    const std::int64_t next = rounded();
    block.weights.push_back(next - boundary);
    boundary = next;
  }
  block.boundaries.push_back(boundary - start);
  return block;
}

}  // namespace nutik
