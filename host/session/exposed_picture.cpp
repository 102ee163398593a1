#include "session/exposed_picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/format.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {
namespace {

// A function with delays is one for each mask value: weighed by its whole course, of all its pixels, with the samples
// that any of them needs.
std::vector<PlannedFunction> by_mask_value(const RenderPlan& plan) {
  std::vector<PlannedFunction> functions;
  for (const PlannedFunction& delayed : plan.functions) {
    if (functions.empty() || functions.back().tag != delayed.tag) {
      PlannedFunction& function = functions.emplace_back(delayed);
      function.summary = summarize_course(function.function, plan.duration_ns);
      function.summary.support_ns = delayed.summary.support_ns;  // a traced one is moved already: D is not
      continue;
    }
    PlannedFunction& function = functions.back();
    function.pixel_count += delayed.pixel_count;
    function.live.cover(delayed.live);
  }
  return functions;
}

}  // namespace

std::uint64_t infinite_values(const Picture& picture) {
  if (picture.type != ValueType::light32) return 0;
  return static_cast<std::uint64_t>(
      std::ranges::count_if(picture.values<float>(), [](float value) { return !std::isfinite(value); }));
}

std::optional<std::string> infinity_warning(const Picture& picture) {
  const std::uint64_t count = infinite_values(picture);
  if (count == 0) return std::nullopt;
  return format(
      "{} of {} values are beyond floating point of 32 bits, which ends at 3.4e38, and infinite; "
      "expose with smaller gains",
      count, picture.shape.value_count());
}

ExposureFigures ExposureFigures::of(RenderPlan&& plan, const Timeline& timeline,
                                    std::optional<std::uint64_t> block_count) {
  ExposureFigures figures{plan.capture, timeline, {}, plan.exposed_sample_count(), {}, plan.blocks.size(),
                          block_count,  0,        0};
  if (!plan.blocks.empty()) {
    figures.read = {plan.blocks.front().extent.range().first, plan.blocks.back().extent.range().last};
  }
  figures.table_bytes = 2 * plan.row_count() * plan.function_count() * sizeof(double);
  figures.map_bytes = plan.map->bytes();
  figures.combine = plan.combine;
  for (const PlannedFunction& function : plan.functions) {
    figures.error_scale = std::max(figures.error_scale, nutik::error_scale(function, plan.combine));
    figures.times_error = std::max(figures.times_error, nutik::times_error(function, timeline));
  }
  figures.has_delays = plan.map->has_delays();
  figures.functions = figures.has_delays ? by_mask_value(plan) : std::move(plan.functions);
  for (PlannedFunction& function : figures.functions) function.table.reset();  // its memory is the session's
  return figures;
}

}  // namespace nutik
