#include "render/render_plan.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "exposure/function_check.hpp"
#include "render/plan_cache.hpp"
#include "system/parallel.hpp"

namespace nutik {

std::uint64_t RenderPlan::row_count() const {
  return blocks.empty() ? 0 : blocks.back().table_row + blocks.back().row_count();
}

bool RenderPlan::has_bundles() const {
  return std::ranges::any_of(blocks, [this](const PlannedBlock& planned) {
    return std::ranges::any_of(functions, [&](const PlannedFunction& function) {
      return function.table->steady_in(planned.block).bundle.is_bundle();
    });
  });
}

bool RenderPlan::is_corrected(const PlannedBlock& planned) const {
  return std::ranges::any_of(functions, [&](const PlannedFunction& function) {
    return function.table->has_corrected() && !function.table->steady_in(planned.block).corrected.empty();
  });
}

bool RenderPlan::has_corrected() const {
  return std::ranges::any_of(functions,
                             [](const PlannedFunction& function) { return function.table->has_corrected(); });
}

double error_scale(const PlannedFunction& function, Combine combine) {
  return combine == Combine::integral ? function.summary.error_scale() : function.function.largest_gain();
}

double RenderPlan::error_scale(std::uint64_t pixel) const {
  const std::span<const Share> shares = shares_of(pixel);
  if (shares.empty()) return nutik::error_scale(functions[function_of(pixel)], combine);
  double scale = 0.0;
  for (const Share& share : shares)
    scale += share.size * nutik::error_scale(functions[share.of], combine) / kWholeShare;
  return scale;
}

SampleRange exposed_samples(const PlannedFunction& planned, const Timeline& timeline) {
  if (planned.live != live_samples(planned.summary, timeline, false))
    return planned.live;  // all were asked for
  const Interval meant = meant_interval(
      planned.delay_ns == 0 ? planned.function : planned.function.shifted(planned.delay_ns), planned.summary);
  return timeline.samples_reaching(meant.begin_ns, meant.end_ns);
}

std::uint64_t RenderPlan::exposed_sample_count() const {
  std::vector<SampleRange> ranges;
  for (const PlannedFunction& function : functions)
    ranges.push_back(exposed_samples(function, layout->timeline));
  std::ranges::sort(ranges, {}, &SampleRange::first);
  std::uint64_t samples = 0, counted_to = 0;
  for (const SampleRange& range : ranges) {
    if (range.last <= counted_to) continue;
    samples += range.last - std::max(range.first, counted_to);
    counted_to = range.last;
  }
  return samples;
}

void measure_tables(const RenderPlan& plan, const std::stop_token& stop) {
  std::vector<const GainTable*> unmeasured;
  for (const PlannedFunction& function : plan.functions) {
    if (!function.table->is_measured()) unmeasured.push_back(function.table.get());
  }
  parallel_for(unmeasured.size(), [&](std::uint64_t i) {
    if (stop.stop_requested()) throw Cancelled();
    static_cast<void>(unmeasured[i]->course());
  });
}

SampleRange needed_samples(const Timeline& timeline, const FunctionSet& functions, const Mask& mask,
                           const PlanOptions& options) {
  SampleRange needed;
  for (const MaskRegion& region : regions_of(mask)) {
    const auto found = functions.find(region.tag);
    if (found == functions.end()) continue;
    // Whatever delays occur in the picture, though perhaps not with this function.
    static const std::vector<std::int64_t> kNone{0};
    for (const std::int64_t delay_ns : options.delays ? options.delays->delays_ns : kNone) {
      const GainSummary summary = summarize(found->second.shifted(delay_ns), timeline.duration_ns());
      needed.cover(live_samples(summary, timeline, options.live_all));
    }
  }
  return needed;
}

RenderPlan make_plan(const CaptureSource& source, const FunctionSet& functions, const Mask& mask,
                     const PlanOptions& options) {
  return PlanCache().plan(source, functions, mask, options);
}

}  // namespace nutik
