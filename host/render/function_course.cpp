#include "render/function_course.hpp"

#include <algorithm>
#include <cmath>

namespace nutik {
namespace {

// A number as the kernel's table holds it.
double as_single(double number) { return static_cast<float>(number); }
double as_pair(double number) {
  const double high = as_single(number);
  return high + as_single(number - high);
}

}  // namespace

double FunctionCourse::boundary_errors(Precision precision) const {
  switch (precision) {
    case Precision::single_: return single_boundary_errors;
    case Precision::compensated: return pair_boundary_errors;
    case Precision::double_:
    case Precision::fixed: break;
  }
  return 0.0;
}

void CourseMeter::Extent::add(double weight) { (weight > 0.0 ? above : below) += std::fabs(weight); }
double CourseMeter::Extent::largest() const { return std::max(above, below); }

void CourseMeter::add(const BlockTable& table, const SteadyGain& steady) {
  if (table.weights.empty()) return;
  // A steady block's table holds what the gain is multiplied to. What a number loses changes by no more than the number
  // does, which is known to so many roundings here.
  const double factor = steady.is_steady() ? std::fabs(steady.per_ns) : 1.0;
  const double known_to = steady.is_steady() ? 15 * 0x1p-53 : 0.0;
  Extent block;
  for (std::size_t i = 0; i < table.weights.size(); ++i) {
    const double weight = table.weights[i];
    const double boundary = table.boundaries[i + 1];
    block.add(weight);
    magnitude_.add(std::fabs(weight));
    if (i > 0) course_.partial_sums += block.largest();
    course_.boundaries += std::fabs(boundary);
    const double stored = boundary / factor;
    const double unknown = known_to * std::fabs(stored);
    course_.single_boundary_errors += factor * (std::fabs(stored - as_single(stored)) + unknown);
    course_.pair_boundary_errors += factor * (std::fabs(stored - as_pair(stored)) + unknown);
    course_.weight_count += weight != 0.0;
  }
  if (steady.is_steady()) course_.steady_magnitude += block.above + block.below;
  capture_.above += block.above;
  capture_.below += block.below;
  if (course_.block_count > 0) course_.block_sums += capture_.largest();
  course_.longest_block = std::max(course_.longest_block, static_cast<double>(table.weights.size()));
  course_.block_count += 1;
  course_.sample_count += static_cast<double>(table.weights.size());
}

void CourseMeter::add_corrected(const BlockTable& table, const SteadyGain& steady, const HatNumbers& hats) {
  const double before = capture_.above + capture_.below;
  const auto with_gain = [&](std::vector<double> numbers) {
    for (double& number : numbers) number *= steady.per_ns;
    return numbers;
  };
  const std::vector<double> weights = with_gain(hats.weights), boundaries = with_gain(hats.boundaries);
  add({{}, weights, boundaries, {}}, steady);
  const CorrectionNumbers correction = correction_of(steady, hats, table.span, table.weights);
  add({{}, correction.weights, correction.boundaries, {}}, {});
  course_.corrected_magnitude += capture_.above + capture_.below - before;
}

FunctionCourse CourseMeter::course() const {
  FunctionCourse course = course_;
  course.magnitude = capture_.above + capture_.below;
  course.extent = capture_.largest();
  course.compensated_magnitude = magnitude_.value();
  return course;
}

}  // namespace nutik
