#include "render/function_course.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

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

void CourseMeter::add_single(double error, double own_weight) {
  constexpr int kLast = std::tuple_size_v<decltype(like_samples_)> - 1;  // of those that add no light, too
  has_negative_ |= own_weight < 0.0;
  if (error == 0.0) return;
  const double slope = error / own_weight;
  const int at = slope < 0x1p6 ? std::clamp(2 * std::ilogb(slope / kRoundoff32), 0, kLast - 1) : kLast;
  LikeSamples& like = like_samples_[static_cast<std::size_t>(at)];
  like.slope = std::max(like.slope, slope);
  like.error += error;
  like.weight += own_weight;
}

// Samples of light v in [0, 1] err by no more than Σ c v. Whatever the slope, that is at most
// Σ max(0, c - slope · w) + slope · Σ w v.
std::vector<LightLine> CourseMeter::single_lines() const {
  std::vector<LightLine> lines;
  if (has_negative_) return lines;
  LightLine line;
  for (std::size_t at = 0; at + 1 < like_samples_.size(); ++at) {
    if (at > 0 && like_samples_[at].error == 0.0) continue;
    line.slope = std::max(line.slope, like_samples_[at].slope);
    line.constant = 0.0;
    for (std::size_t steeper = at + 1; steeper < like_samples_.size(); ++steeper) {
      line.constant += std::max(0.0, like_samples_[steeper].error - line.slope * like_samples_[steeper].weight);
    }
    lines.push_back(line);
  }
  return lines;
}

void CourseMeter::add(const BlockTable& table, const SteadyGain& steady, std::span<const double> own) {
  if (table.weights.empty()) return;
  // A steady block's table holds what the gain is multiplied to. What a number loses changes by no more than the number
  // does, which is known to so many roundings here.
  const double factor = steady.is_steady() ? std::fabs(steady.per_ns) : 1.0;
  const double known_to = steady.is_steady() ? 15 * 0x1p-53 : 0.0;
  Extent block;
  double missed_before = 0.0;  // of the boundary before, which is 0 at first
  for (std::size_t i = 0; i < table.weights.size(); ++i) {
    const double weight = table.weights[i];
    const double boundary = table.boundaries[i + 1];
    block.add(weight);
    magnitude_.add(std::fabs(weight));
    if (i > 0) course_.partial_sums += block.largest();
    course_.boundaries += std::fabs(boundary);
    const double stored = boundary / factor;
    const double unknown = known_to * std::fabs(stored);
    const double missed = stored - as_single(stored);
    course_.single_boundary_errors += factor * (std::fabs(missed) + unknown);
    const auto sums = static_cast<double>(table.weights.size() - std::max<std::size_t>(i, 1));
    add_single(kRoundoff32 * sums * std::fabs(weight) + factor * (std::fabs(missed - missed_before) + 2 * unknown),
               own[i]);
    course_.overshoot += std::fabs(weight - own[i]);
    missed_before = missed;
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
  const auto is_steady = [&](std::uint32_t k) { return k >= hats.span.first && k < hats.span.last; };
  std::vector<double> own = weights;
  for (std::uint32_t k = steady.corrected.first; k < steady.corrected.last; ++k) {
    if (is_steady(k)) own[k - hats.span.first] = 0.0;
  }
  add({{}, weights, boundaries, {}}, steady, own);
  const CorrectionNumbers correction = correction_of(steady, hats, table.span, table.weights);
  own = correction.weights;
  for (std::uint32_t k = steady.corrected.first; k < steady.corrected.last; ++k) {
    if (is_steady(k)) own[k - steady.corrected.first] = 0.0;
  }
  add({{}, correction.weights, correction.boundaries, {}}, {}, own);
  course_.corrected_magnitude += capture_.above + capture_.below - before;
}

FunctionCourse CourseMeter::course() const {
  FunctionCourse course = course_;
  course.magnitude = capture_.above + capture_.below;
  course.extent = capture_.largest();
  course.compensated_magnitude = magnitude_.value();
  course.single_lines = single_lines();
  return course;
}

}  // namespace nutik
