#include "app/output/exposure_report.hpp"

#include <algorithm>

#include "capture/format.hpp"
#include "session/size_text.hpp"
#include "session/time_text.hpp"

namespace nutik::app {
namespace {

constexpr std::size_t kFunctionsInSummary = 6;

}  // namespace

std::string still_gains_text(const RenderPlan& plan, bool plain) {
  if (plain && !plan.functions.empty()) {
    return format(", still gain {:.6g}", plan.functions.front().summary.still_gain());
  }
  std::string text = ", still gain";
  for (std::size_t f = 0; f < std::min(plan.functions.size(), kFunctionsInSummary); ++f) {
    const PlannedFunction& function = plan.functions[f];
    text += format("{} M{} {:.6g}", f == 0 ? "" : ",", function.tag, function.summary.still_gain());
  }
  if (plan.functions.size() > kFunctionsInSummary) {
    text += format(" and {} more", plan.functions.size() - kFunctionsInSummary);
  }
  return text;
}

std::string saturation_text(const Saturation& saturation, ValueType type) {
  if (!holds_codes(type)) return {};
  if (saturation == Saturation{}) return ", no pixel saturated";
  const auto pixels = [](std::uint64_t count) { return counted(count, "pixel"); };
  if (saturation.above == 0) return format(", {} saturated below 0", pixels(saturation.below));
  if (saturation.below == 0) return format(", {} saturated above 1", pixels(saturation.above));
  return format(", {} saturated below 0 and {} above 1", pixels(saturation.below), saturation.above);
}

std::string plan_text(const RenderPlan& plan, const Timeline& timeline,
                      std::optional<std::uint64_t> block_count) {
  std::string text = "plan: ";
  if (plan.blocks.empty()) {
    text += "nothing is read: no gain within the capture differs from 0";
  } else {
    const std::uint64_t first = plan.blocks.front().extent.range().first;
    const std::uint64_t last = plan.blocks.back().extent.range().last;
    text += format("{} of {} samples have a gain that differs from 0; ", plan.live_sample_count(),
                   timeline.sample_count());
    text += format("read: {} (samples {} … {})", counted(plan.blocks.size(), "block"), first, last - 1);
    if (block_count) {
      text += format(", skipped: {}", counted(*block_count - plan.blocks.size(), "block"));
    } else if (last < timeline.sample_count()) {
      text += format("; the clip is decoded up to there");
    }
  }
  const auto time = [](std::int64_t ns) { return integral_text(static_cast<double>(ns)); };
  for (std::size_t f = 0; f < std::min(plan.functions.size(), kFunctionsInSummary); ++f) {
    const PlannedFunction& function = plan.functions[f];
    const Interval& live = function.summary.live;
    text +=
        format("\n  M{}: {}, {}, {}", function.tag, counted(function.pixel_count, "pixel"),
               live.empty() ? "never live" : format("live {} … {}", time(live.begin_ns), time(live.end_ns)),
               counted(function.live.size(), "sample"));
  }
  if (plan.functions.size() > kFunctionsInSummary) {
    text += format("\n  and {} functions more", plan.functions.size() - kFunctionsInSummary);
  }
  const std::uint64_t tables = 2 * plan.row_count() * plan.function_count() * sizeof(double);
  return text + format("\n  tables of gains: {}; map of functions: {}", bytes_text(tables),
                       bytes_text(plan.map->region_of_pixel.size()));
}

Json functions_json(const RenderPlan& plan) {
  Json functions = Json::array();
  for (const PlannedFunction& function : plan.functions) {
    functions.push_back({{"mask_value", function.tag},
                         {"pixels", function.pixel_count},
                         {"live_start_ns", function.summary.live.begin_ns},
                         {"live_end_ns", function.summary.live.end_ns},
                         {"still_gain", function.summary.still_gain()},
                         {"samples", function.live.size()}});
  }
  return functions;
}

void add_saturation(Json& json, const Saturation& saturation, ValueType type) {
  if (!holds_codes(type)) return;
  json["saturated_below_pixels"] = saturation.below;
  json["saturated_above_pixels"] = saturation.above;
}

}  // namespace nutik::app
