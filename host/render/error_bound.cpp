#include "render/error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "render/fixed_scale.hpp"
#include "render/function_course.hpp"

namespace nutik {
namespace {

constexpr double kRoundoff64 = 0x1p-53;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// In u₆₄ of S, whatever the kernel's arithmetic: weights 26, the reference 30, codes to light and sums
// to light in double 16.
constexpr double kDoubleRoundings = 26 + 30 + 16;

// In u₆₄ of corrected blocks and their corrections: a steady weight is a product, a correction a difference.
constexpr double kCorrectedRoundings = 2;

// Light of a code in single precision by a curve or by pieces, for any white code and any device.
constexpr double kCurveLight = 3.3e-7;

// The same by the light itself: nearly all of it is the fit's.
constexpr LightLine kCurveLine{1.9e-7, 4 * kRoundoff32};

// In u₆₄, what thresholds between codes err by before they are rounded to the kernel's table.
constexpr double kThresholdRoundings = 16;

// How closely the most that codes err by is found, from above.
constexpr double kFinely = 1.01;

// What doubles lose that are too small to be normal, in the reference and in the light of sums.
constexpr double kSmallest = 16 * std::numeric_limits<double>::denorm_min();

// What an arithmetic adds to the error, to first order: multiples of `unit` for each of a function's measures.
struct Roundings {
  double unit;    // what one rounding errs by
  double of_sum;  // each term added to others, or block to those before, of the largest that the sum can be
  double of_weight;    // each weight: rounding it, or a difference of boundaries, the product, adding it
  double of_steady;    // each weight of a steady block besides: the gain, its product; bundles that are added
  double of_boundary;  // each boundary that a difference is made of
  double of_share;     // each share of a light: making it a number, the product, adding it
  double light;        // codes to light, absolute
  LightLine light_line;
  double threshold;    // between codes, absolute
  double unnormal;     // numbers too small to be normal: each operation, in scaled gain
  double growth;       // a bound for what first order leaves out, each rounding in a row
};

Roundings roundings_of(Precision precision, const Transfer& transfer) {
  constexpr double kPair = kRoundoff32 * kRoundoff32;  // what is lost beyond two floats
  const bool has_table = !transfer.is_linear();
  switch (precision) {
    case Precision::single_: {
      const double light = transfer.toe() ? kCurveLight : has_table ? kRoundoff32 : 0.0;
      const LightLine line = transfer.toe() ? kCurveLine : LightLine{has_table ? 0x1p-126 : 0.0, light};
      return {kRoundoff32, 1, 2, 2, 0, 3, light, line, kRoundoff32, 0x1p-122, kRoundoff32};
    }
    case Precision::compensated:
      return {kPair, 3, 17, 17, 4, 20, has_table ? kPair : 0.0, {}, kPair, 0x1p-122, kRoundoff32};
    case Precision::double_:
    case Precision::fixed: break;
  }
  return {kRoundoff64, 1, 2, 2, 0, 3, 0.0, {}, kRoundoff64, 0.0, kRoundoff64};
}

// For what first order leaves out: a factor.
double growth_of(const FunctionCourse& course, const Roundings& roundings) {
  const double growth = roundings.growth * (course.longest_block + course.block_count + 10);
  return growth < 0.5 ? 1 / (1 - growth) : kInfinite;
}

double floating_error(const FunctionCourse& course, Precision precision, const Roundings& roundings) {
  const double first_order = roundings.unit * (roundings.of_sum * (course.partial_sums + course.block_sums) +
                                               roundings.of_weight * course.magnitude +
                                               roundings.of_steady * course.steady_magnitude +
                                               roundings.of_boundary * course.boundaries) +
                             course.boundary_errors(precision) + roundings.light * course.magnitude +
                             roundings.unnormal * (course.sample_count + course.block_count);
  return first_order * growth_of(course, roundings);
}

// What single errs by, where the function is nowhere below 0: for each of the course's lines.
std::vector<LightLine> single_lines(const FunctionCourse& course, const Roundings& roundings) {
  const double sums = roundings.of_sum * std::max(0.0, course.block_count - 1);
  const double weights = roundings.of_weight + (course.steady_magnitude > 0.0 ? roundings.of_steady : 0.0);
  const double slope = roundings.unit * (sums + weights) + roundings.light_line.slope;
  const double constant = slope * course.overshoot + roundings.light_line.constant * course.magnitude +
                          roundings.unnormal * (course.sample_count + course.block_count);
  const double growth = growth_of(course, roundings);
  std::vector<LightLine> lines = course.single_lines;
  for (LightLine& line : lines) line = {growth * (line.constant + constant), growth * (line.slope + slope)};
  return lines;
}

double fixed_error(const FunctionCourse& course, const FixedScale& scale, std::size_t function,
                   bool is_linear) {
  const double light = is_linear ? 0.0 : std::scalbn(0.5, -scale.light_bits);
  const auto weights = static_cast<double>(course.weight_count);
  const double boundaries = std::scalbn((weights + 1) / 2, -scale.exponents[function]);
  const double running_sum = kRoundoff64 * (weights + 2) * course.extent;
  return light * course.magnitude + (boundaries + running_sum) * (1 + light);
}

// In u₆₄ of a mixed pixel's S: the reference's products, their sum, the division.
constexpr double kReferenceBlend = 3;

// In units of the scale on which whole lights are blended: what each light and their sum are rounded down by.
constexpr double kFixedBlendUnits = 2;

// What blending the lights of so many functions rounds, beside units of whole numbers, by what lights come to by their
// shares. The host blends light in double, where none is too small.
LightLine blend_line(const Roundings& roundings, const OutputFormat& output, std::size_t functions) {
  const auto count = static_cast<double>(functions);
  const double relative =
      roundings.unit * (roundings.of_share + roundings.of_sum * (count - 1)) + kReferenceBlend * kRoundoff64;
  const double growth = roundings.growth * (count + 8);
  return {(holds_codes(output.type) ? roundings.unnormal * count : 0.0) + kSmallest, relative / (1 - growth)};
}

double blend_error(const Roundings& roundings, const OutputFormat& output, std::size_t functions,
                   double magnitude) {
  const LightLine line = blend_line(roundings, output, functions);
  return line.constant + line.slope * magnitude;
}

// What lights that err by `line` at most err by once they are blended.
LightLine blended(const LightLine& line, const LightLine& blend) {
  return {line.constant * (1 + blend.slope) + blend.constant, line.slope * (1 + blend.slope) + blend.slope};
}

// Kernels blend codes in whole numbers; light is blended by the host, in double.
double fixed_blend_error(const RenderPlan& plan, const ErrorBound& bound) {
  if (plan.map->mixed.empty() || bound.precision != Precision::fixed || !holds_codes(bound.output.type))
    return 0.0;
  const FixedScale scale = fixed_scale(plan);
  return kFixedBlendUnits / std::scalbn(static_cast<double>(scale.white_light),
                                        kCodeBits - scale.light_bits - scale.blend_shift);
}

double in_steps(const RenderPlan& plan, double scale, double light, double threshold,
                const OutputFormat& output) {
  if (holds_codes(output.type)) {
    const CodeMaking making = CodeMaking::of(plan.capture, output);
    const double seen = making.conversion ? converted_error(*making.conversion, light, scale) : light;
    return code_error(making.transfer, output.white_code, {seen / making.white_light + threshold, 0.0});
  }
  return scale > 0.0 ? light / format_step(output, scale) : 0.0;
}

// In codes. Other primaries mix light of other channels into a channel's own, and cameras' curves bend both ways, which
// code_error() does not look for.
double line_steps(const RenderPlan& plan, const LightLine& line, const Roundings& roundings,
                  const OutputFormat& output) {
  const CodeMaking making = CodeMaking::of(plan.capture, output);
  if (making.conversion || making.transfer.kind() == Transfer::Kind::log) return kInfinite;
  const LightLine seen{line.constant / making.white_light + kThresholdRoundings * kRoundoff64,
                       line.slope + roundings.threshold};
  return code_error(making.transfer, output.white_code, seen);
}

// Takes the line that costs least of a picture of codes, where it has some: what codes err by then.
double take_best(const RenderPlan& plan, std::span<const LightLine> lines, const Roundings& roundings,
                 const OutputFormat& output, PictureError& error) {
  if (!holds_codes(output.type)) return kInfinite;
  const Transfer transfer = CodeMaking::of(plan.capture, output).transfer;
  double least = kInfinite;
  for (const LightLine& line : lines) {
    // Roughly in codes: few functions are steeper than that at their bright end. Any line will do.
    const double cost = transfer.fraction_of(line.constant) + line.slope / 2;
    if (!(cost < least)) continue;
    least = cost;
    error.line = line;
  }
  return least < kInfinite ? line_steps(plan, error.line, roundings, output) : kInfinite;
}

// Its constant is infinite where light has no line.
LightLine line_of(const PictureError& error) {
  return error.light > 0.0 && error.line.slope == 0.0 ? LightLine{kInfinite, 0.0} : error.line;
}

// Bounds any mixture of the plan's functions: no larger than the worst of them, and what blending that rounds.
void add_blending(const RenderPlan& plan, const Roundings& roundings, ErrorBound& bound) {
  double largest = 0.0, min_scale = kInfinite;
  LightLine line;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    const double scale = plan.functions[f].summary.error_scale();
    largest = std::max(largest, scale + bound.functions[f].light);
    if (scale > 0.0) min_scale = std::min(min_scale, scale / kWholeShare);  // of a mixture with zeros
    const LightLine own = line_of(bound.functions[f]);
    line = {std::max(line.constant, own.constant), std::max(line.slope, own.slope)};
  }
  const std::size_t functions = plan.map->mixed.max_functions();
  const double light = bound.worst.light + blend_error(roundings, bound.output, functions, largest) +
                       fixed_blend_error(plan, bound);
  bound.worst.light = light;
  if (holds_codes(bound.output.type)) {
    bound.worst.steps = in_steps(plan, largest, light, threshold_error(bound.precision), bound.output);
    const LightLine seen = blended(line, blend_line(roundings, bound.output, functions));
    const double steps = take_best(plan, {&seen, 1}, roundings, bound.output, bound.worst);
    bound.worst.steps = std::min(bound.worst.steps, kFinely * steps);  // no pixel's may be found to be larger
  } else if (largest > 0.0) {
    // Relative to the pixel's own S, of which each function's error and every rounding are a share.
    const double blend = blend_error(roundings, bound.output, functions, min_scale);
    bound.worst.steps =
        bound.worst.steps * (1 + blend / min_scale) + in_steps(plan, min_scale, blend, 0.0, bound.output);
  }
}

}  // namespace

double threshold_error(Precision precision) {
  return roundings_of(precision, Transfer::linear()).threshold + kThresholdRoundings * kRoundoff64;
}

double converted_error(const ColourMatrix& matrix, double light, double scale) {
  constexpr double kMatrixRoundings = 4;  // in u₆₄ of what is added up
  double largest_row = 0.0;
  for (const auto& row : matrix) {
    largest_row = std::max(largest_row, std::fabs(row[0]) + std::fabs(row[1]) + std::fabs(row[2]));
  }
  return largest_row * (light + kMatrixRoundings * kRoundoff64 * (scale + light));
}

double format_step(const OutputFormat& output, double scale) {
  if (output.type == ValueType::light64) return std::max(scale * 2e-12, std::numeric_limits<double>::denorm_min());
  return output.is_half ? std::max(scale * 0x1p-10, 0x1p-24) : std::max(scale * 0x1p-23, 0x1p-149);
}

double code_error(const Transfer& transfer, std::uint32_t white_code, const LightLine& error) {
  // From the darker of two lights to the brighter one.
  const double left = 1.0 - error.slope;
  const double constant = error.constant / left, slope = error.slope / left;
  if (!(constant + slope < 1.0) || !(left > 0.0)) return white_code;
  double found = transfer.fraction_of(constant) - transfer.fraction_of(0.0), largest = 0.0, ratio = 2.0;
  for (double to = 1.0; to > 0.0;) {
    const double from = slope * to > constant / 128 ? to / ratio : 0.0;
    const double light = constant + slope * to;
    // Between two lights the function is steepest at the darker if it bends down, else at the brighter.
    const double at_to = transfer.fraction_of(to) - transfer.fraction_of(std::max(0.0, to - light));
    const double at_most = std::max(at_to, transfer.fraction_of(from + light) - transfer.fraction_of(from));
    found = std::max(found, at_to);
    if (at_most > kFinely * found && ratio > kFinely && from > 0.0) {
      ratio = std::sqrt(ratio);
      continue;
    }
    largest = std::max(largest, at_most);
    to = from;
    ratio *= ratio;
  }
  return white_code * largest;
}

ErrorBound error_bound(const RenderPlan& plan, Precision precision, const OutputFormat& output) {
  if (plan.combine != Combine::integral)  // the reference's to the last bit
    return {precision, std::vector<PictureError>(plan.functions.size()), {}, output};
  const Roundings roundings = roundings_of(precision, plan.capture.transfer);
  const FixedScale scale = precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
  ErrorBound bound{precision, {}, {}, output};
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    const GainSummary& gain = plan.functions[f].summary;
    PictureError error;
    if (gain.support_ns > 0) {
      const GainTable& table = *plan.functions[f].table;
      const FunctionCourse& course = precision == Precision::fixed ? table.course() : table.parted_course();
      const double sums = precision == Precision::fixed
                              ? fixed_error(course, scale, f, plan.capture.transfer.is_linear())
                              : floating_error(course, precision, roundings);
      const double tables =
          kRoundoff64 * (kDoubleRoundings * gain.absolute_integral_ns / static_cast<double>(gain.support_ns) +
                         kCorrectedRoundings * course.corrected_magnitude + course.boundaries);
      const auto in_light = [&](double scaled) { return std::scalbn(scaled + tables, gain.exponent) + kSmallest; };
      error.light = in_light(sums);
      error.steps = in_steps(plan, gain.error_scale(), error.light, threshold_error(bound.precision), output);
      if (precision == Precision::single_) {
        std::vector<LightLine> lines = single_lines(course, roundings);
        for (LightLine& line : lines) line.constant = in_light(line.constant);
        error.steps = std::min(error.steps, take_best(plan, lines, roundings, output, error));
      }
    }
    bound.functions.push_back(error);
    bound.worst.light = std::max(bound.worst.light, error.light);
    bound.worst.steps = std::max(bound.worst.steps, error.steps);
  }
  if (!plan.map->mixed.empty()) add_blending(plan, roundings, bound);
  return bound;
}

ErrorBound reference_bound(const RenderPlan& plan, const OutputFormat& output) {
  ErrorBound bound{Precision::double_, {}, {}, output};
  for (const PlannedFunction& function : plan.functions) {
    const double scale = error_scale(function, plan.combine);
    PictureError error{kReferenceError * scale, 0.0};
    error.steps = in_steps(plan, scale, error.light, 0.0, output);
    bound.functions.push_back(error);
    bound.worst.light = std::max(bound.worst.light, error.light);
    bound.worst.steps = std::max(bound.worst.steps, error.steps);
  }
  return bound;
}

PixelErrors::PixelErrors(const RenderPlan& plan, const ErrorBound& bound)
    : plan_(plan), bound_(bound), fixed_blend_(fixed_blend_error(plan, bound)) {}

PictureError PixelErrors::of(std::uint64_t pixel) const {
  const std::span<const Share> shares = plan_.shares_of(pixel);
  if (shares.empty()) return bound_.functions[plan_.function_of(pixel)];
  const Roundings roundings = roundings_of(bound_.precision, plan_.capture.transfer);
  double of_functions = 0.0;
  LightLine line;
  for (const Share& share : shares) {
    const PictureError& function = bound_.functions[share.of];
    of_functions += share.size * function.light / kWholeShare;
    const LightLine own = line_of(function);
    line = {line.constant + share.size * own.constant / kWholeShare, std::max(line.slope, own.slope)};
  }
  const double scale = plan_.error_scale(pixel);
  PictureError error;
  error.light = of_functions + blend_error(roundings, bound_.output, shares.size(), scale + of_functions) +
                fixed_blend_;
  error.steps = in_steps(plan_, scale, error.light, threshold_error(bound_.precision), bound_.output);
  const LightLine seen = blended(line, blend_line(roundings, bound_.output, shares.size()));
  error.steps = std::min(error.steps, take_best(plan_, {&seen, 1}, roundings, bound_.output, error));
  return error;
}

}  // namespace nutik
