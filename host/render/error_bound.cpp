#include "render/error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/fixed_scale.hpp"

namespace nutik {
namespace {

constexpr double kRoundoff64 = 0x1p-53;
constexpr double kRoundoff32 = 0x1p-24;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// In u₆₄ of S, whatever the kernel's arithmetic: weights 26, the reference 30, codes to light and sums
// to light in double 16.
constexpr double kDoubleRoundings = 26 + 30 + 16;

// Light of a code in single precision by a curve or by pieces, for any white code and any device.
constexpr double kCurveLight = 3.3e-7;

// In u₆₄, what thresholds between codes err by before they are rounded to the kernel's table.
constexpr double kThresholdRoundings = 16;

// What doubles lose that are too small to be normal, in the reference and in the light of sums.
constexpr double kSmallest = 16 * std::numeric_limits<double>::denorm_min();

// What an arithmetic adds to the error, to first order: multiples of `unit` for each of a function's measures.
struct Roundings {
  double unit;            // what one rounding errs by
  double of_sum;          // each term added to others, or block to those before, of the largest that the sum can be
  double of_weight;       // each weight: rounding it, or a difference of boundaries, the product, adding it
  double of_boundary;     // each boundary that a difference is made of
  double light;           // codes to light, absolute
  double threshold;       // between codes, absolute
  double unnormal;        // numbers too small to be normal: each operation, in scaled gain
  double growth;          // a bound for what first order leaves out, each rounding in a row
};

// A number as the kernel's table holds it.
double in_table(Precision precision, double number) {
  const double high = static_cast<float>(number);
  switch (precision) {
    case Precision::single_: return high;
    case Precision::compensated: return high + static_cast<float>(number - high);
    case Precision::double_:
    case Precision::fixed: break;
  }
  return number;
}

Roundings roundings_of(Precision precision, const Transfer& transfer) {
  constexpr double kPair = kRoundoff32 * kRoundoff32;  // what is lost beyond two floats
  const bool has_table = !transfer.is_linear();
  switch (precision) {
    case Precision::single_: {
      const double light = transfer.toe() ? kCurveLight : has_table ? kRoundoff32 : 0.0;
      return {kRoundoff32, 1, 2, 0, light, kRoundoff32, 0x1p-122, kRoundoff32};
    }
    case Precision::compensated:
      return {kPair, 3, 17, 4, has_table ? kPair : 0.0, kPair, 0x1p-122, kRoundoff32};
    case Precision::double_:
    case Precision::fixed: break;
  }
  return {kRoundoff64, 1, 2, 0, 0.0, kRoundoff64, 0.0, kRoundoff64};
}

// Between what a sum of light · weight can lie for light in [0, 1]: -below … above.
struct Extent {
  double above = 0.0;
  double below = 0.0;

  void add(double weight) { (weight > 0.0 ? above : below) += std::fabs(weight); }
  [[nodiscard]] double largest() const { return std::max(above, below); }
};

// What the sums of one function can come to, over all light in [0, 1].
struct Course {
  double magnitude = 0.0;        // Σ|w|
  double extent = 0.0;           // the largest that the whole sum can be
  double partial_sums = 0.0;     // Σ over samples but a block's first: the same of their block's sum up to them
  double block_sums = 0.0;       // Σ over blocks but the first: the same of all up to their ends
  double boundaries = 0.0;       // Σ|B|
  double boundary_errors = 0.0;  // Σ of what the kernel's table misses of each boundary
  double weight_count = 0.0;     // that are not 0
  double longest_block = 0.0;    // in live samples
  double block_count = 0.0;      // with live samples
  double sample_count = 0.0;     // live
};

std::vector<Course> courses_of(const RenderPlan& plan, Precision precision) {
  const std::uint64_t count = plan.function_count();
  std::vector<Course> courses(count);
  std::vector<Extent> capture(count), block(count);
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    const SampleSpan* spans = plan.spans.data() + b * count;
    std::fill(block.begin(), block.end(), Extent{});
    for (std::uint32_t k = 0; k < plan.blocks[b].extent.sample_count; ++k) {
      const double* weights = plan.weights.data() + (plan.blocks[b].table_row + k) * count;
      const double* boundaries = plan.boundaries.data() + (plan.blocks[b].table_row + k + 1) * count;
      for (std::uint64_t f = 0; f < count; ++f) {
        if (k < spans[f].first || k >= spans[f].last) continue;
        Course& course = courses[f];
        block[f].add(weights[f]);
        if (k > spans[f].first) course.partial_sums += block[f].largest();
        course.boundaries += std::fabs(boundaries[f]);
        course.boundary_errors += std::fabs(boundaries[f] - in_table(precision, boundaries[f]));
        course.weight_count += weights[f] != 0.0;
      }
    }
    for (std::uint64_t f = 0; f < count; ++f) {
      if (spans[f].first == spans[f].last) continue;
      Course& course = courses[f];
      capture[f].above += block[f].above;
      capture[f].below += block[f].below;
      if (course.block_count > 0) course.block_sums += capture[f].largest();
      course.longest_block = std::max<double>(course.longest_block, spans[f].last - spans[f].first);
      course.block_count += 1;
      course.sample_count += spans[f].last - spans[f].first;
    }
  }
  for (std::uint64_t f = 0; f < count; ++f) {
    courses[f].magnitude = capture[f].above + capture[f].below;
    courses[f].extent = capture[f].largest();
  }
  return courses;
}

double floating_error(const Course& course, const Roundings& roundings) {
  const double first_order =
      roundings.unit *
          (roundings.of_sum * (course.partial_sums + course.block_sums) +
           roundings.of_weight * course.magnitude + roundings.of_boundary * course.boundaries) +
      course.boundary_errors + roundings.light * course.magnitude +
      roundings.unnormal * (course.sample_count + course.block_count);
  const double growth = roundings.growth * (course.longest_block + course.block_count + 8);
  return growth < 0.5 ? first_order / (1 - growth) : kInfinite;
}

double fixed_error(const Course& course, const FixedScale& scale, std::size_t function, bool is_linear) {
  const double light = is_linear ? 0.0 : std::scalbn(0.5, -scale.light_bits);
  const double boundaries = std::scalbn((course.weight_count + 1) / 2, -scale.exponents[function]);
  const double running_sum = kRoundoff64 * (course.weight_count + 2) * course.extent;
  return light * course.magnitude + (boundaries + running_sum) * (1 + light);
}

double in_steps(const RenderPlan& plan, const GainSummary& gain, double light, double threshold,
                const OutputFormat& output) {
  if (holds_codes(output.type)) {
    return code_error(plan.capture.transfer, output.white_code, light + threshold);
  }
  const double scale = gain.error_scale();
  // Numbers of the format have no smaller steps than its least one.
  const double least = output.type == ValueType::light64 ? std::numeric_limits<double>::denorm_min()
                                                         : std::numeric_limits<float>::denorm_min();
  return scale > 0.0 ? light / std::max(scale * format_step(output.type), least) : 0.0;
}

}  // namespace

double format_step(ValueType type) { return type == ValueType::light64 ? 2e-12 : 0x1p-23; }

double code_error(const Transfer& transfer, std::uint32_t white_code, double light) {
  if (!(light < 1.0)) return white_code;
  // Steepest at one end: at 0 where the function bends down, at 1 where it bends up.
  const double at_black = transfer.fraction_of(light);
  const double at_white = 1.0 - transfer.fraction_of(1.0 - light);
  return white_code * std::max(at_black, at_white);
}

ErrorBound error_bound(const RenderPlan& plan, Precision precision, const OutputFormat& output) {
  const Roundings roundings = roundings_of(precision, plan.capture.transfer);
  const FixedScale scale = precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
  const std::vector<Course> courses = courses_of(plan, precision);
  ErrorBound bound{precision, {}, {}};
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    const GainSummary& gain = plan.functions[f].summary;
    PictureError error;
    if (gain.support_ns > 0) {
      const Course& course = courses[f];
      const double sums = precision == Precision::fixed
                              ? fixed_error(course, scale, f, plan.capture.transfer.is_linear())
                              : floating_error(course, roundings);
      const double tables =
          kRoundoff64 * (kDoubleRoundings * gain.absolute_integral_ns / static_cast<double>(gain.support_ns) +
                         course.boundaries);
      error.light = std::scalbn(sums + tables, gain.exponent) + kSmallest;
      error.steps =
          in_steps(plan, gain, error.light, roundings.threshold + kThresholdRoundings * kRoundoff64, output);
    }
    bound.functions.push_back(error);
    bound.worst.light = std::max(bound.worst.light, error.light);
    bound.worst.steps = std::max(bound.worst.steps, error.steps);
  }
  return bound;
}

}  // namespace nutik
