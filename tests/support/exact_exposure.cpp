#include "support/exact_exposure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "support/bounds.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

// Whether g is not 0 somewhere within sample k's reach.
bool is_reached(const std::vector<ExactStretch>& gain, const Timeline& timeline, std::uint64_t k) {
  const std::int64_t begin_ns = timeline.reach_begin_ns(k);
  const std::int64_t end_ns = timeline.reach_end_ns(k);
  for (auto stretch = first_stretch_after(gain, begin_ns); stretch != gain.end(); ++stretch) {
    if (stretch->begin_ns >= end_ns) return false;
    if (!stretch->is_zero()) return true;
  }
  return false;
}

}  // namespace

ExactExposure::ExactExposure(const RenderPlan& plan, const Timeline& timeline, DrawSample sample)
    : plan_(plan), timeline_(timeline), sample_(std::move(sample)) {}

const ExactExposure::Function& ExactExposure::function_at(std::size_t index) const {
  const auto [at, is_new] = functions_.try_emplace(index);
  Function& function = at->second;
  if (!is_new) return function;
  const PlannedFunction& planned = plan_.functions[index];
  const std::vector<ExactStretch> gain = exact_gain(planned.function, plan_.duration_ns, planned.delay_ns);
  function.summary = exact_summary(gain);
  if (planned.is_delayed) {
    function.summary.support_ns = exact_course_support_ns(planned.function, plan_.duration_ns);
  }
  for (std::uint64_t k = 0; k < timeline_.sample_count(); ++k) {
    if (!is_reached(gain, timeline_, k)) continue;
    function.weights_ns.emplace_back(k, exact_weight_ns(gain, timeline_, k));
    if (!rasters_.contains(k)) rasters_.emplace(k, sample_(k));
  }
  return function;
}

template <typename Of>
Exact ExactExposure::mixed(std::uint64_t i, Of of) const {
  const std::uint64_t pixel = i / plan_.capture.shape.channels;
  const std::span<const Share> shares = plan_.shares_of(pixel);
  if (shares.empty()) return of(function_at(plan_.function_of(pixel)));
  Exact sum = 0;
  for (const Share& share : shares) sum += Exact(share.size) / kWholeShare * of(function_at(share.of));
  return sum;
}

Exact ExactExposure::light(std::uint64_t i) const {
  return mixed(i, [&](const Function& function) { return light(function, i); });
}

Exact ExactExposure::scale(std::uint64_t i) const {
  return mixed(i, [](const Function& function) { return function.summary.scale(); });
}

Exact ExactExposure::light(const Function& function, std::uint64_t i) const {
  if (function.summary.support_ns == 0) return 0;
  Exact sum = 0;
  for (const auto& [k, weight_ns] : function.weights_ns) {
    const double fraction =
        static_cast<double>(code_at(plan_.capture, rasters_.at(k), i)) / plan_.capture.white_code;
    sum += weight_ns * Exact(plan_.capture.transfer.light_of(fraction));
  }
  return sum / function.summary.support_ns;
}

std::vector<std::uint64_t> values_to_compare(const RenderPlan& plan, std::size_t most, std::uint64_t seed) {
  const std::uint64_t count = plan.capture.shape.value_count();
  std::set<std::uint64_t> values;
  if (count <= most) {
    for (std::uint64_t i = 0; i < count; ++i) values.insert(i);
    return {values.begin(), values.end()};
  }
  const std::uint32_t channels = plan.capture.shape.channels;
  std::vector<std::size_t> left(plan.function_count(),
                                std::max<std::size_t>(1, most / plan.function_count()));
  const bool takes_each = plan.function_count() <= kMaxComparedFunctions;
  for (std::uint64_t pixel = 0; takes_each && pixel < plan.capture.shape.pixel_count(); ++pixel) {
    std::size_t& wanted = left[plan.function_of(pixel)];
    if (wanted == 0) continue;
    --wanted;
    values.insert(pixel * channels + pixel % channels);
  }
  Random random(seed);
  for (std::size_t i = 0; i < most; ++i) {
    values.insert(static_cast<std::uint64_t>(random.whole(0, static_cast<std::int64_t>(count) - 1)));
  }
  return {values.begin(), values.end()};
}

double worst_roundings(const RenderPlan& plan, const RandomCase& random, const Picture& picture, std::uint64_t seed,
                       double most) {
  const ExactExposure exact(plan, random.timeline, [&](std::uint64_t k) { return random.rasters[k]; });
  double worst = 0.0;
  for (const std::uint64_t value : values_to_compare(plan, 12, seed)) {
    const double rendered = picture.values<double>()[value];
    const double units = error_in(exact.scale(value), rendered, exact.light(value)) / kRoundoff64;
    EXPECT_LE(units, most) << random.text() << ", value " << value << "; rerun: " << rerun(seed);
    worst = std::max(worst, units);
  }
  return worst;
}

}  // namespace nutik::test
