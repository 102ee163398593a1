#include "app/output/exposure_report.hpp"

#include <algorithm>

#include "session/format.hpp"
#include "session/size_text.hpp"
#include "session/time_text.hpp"

namespace nutik::app {
namespace {

constexpr std::size_t kFunctionsInSummary = 6;

}  // namespace

std::vector<std::string> exposure_warnings(const ExposedPicture& exposed) {
  std::vector<std::string> warnings = exposed.warnings;
  if (!holds_codes(exposed.output.type) || exposed.output.negative != NegativeLight::saturate)
    return warnings;
  // Light below 0 is black in a picture of codes: a still scene under a negative still gain disappears.
  for (const PlannedFunction& function : exposed.figures.functions) {
    const double still_gain = function.summary.still_gain();
    if (still_gain >= 0.0) continue;
    warnings.push_back(
        format("M{}: the still gain is {:.6g}: whatever does not move comes out black; --negative "
               "offset shows light below 0, a .pfm or a .tif with --depth float keeps it",
               function.tag, still_gain));
  }
  return warnings;
}

std::string still_gains_text(const ExposureFigures& figures, bool plain) {
  if (plain && !figures.functions.empty()) {
    return format(", still gain {:.6g}", figures.functions.front().summary.still_gain());
  }
  std::string text = ", still gain";
  for (std::size_t f = 0; f < std::min(figures.functions.size(), kFunctionsInSummary); ++f) {
    const PlannedFunction& function = figures.functions[f];
    text += format("{} M{} {:.6g}", f == 0 ? "" : ",", function.tag, function.summary.still_gain());
  }
  if (figures.functions.size() > kFunctionsInSummary) {
    text += format(" and {} more", figures.functions.size() - kFunctionsInSummary);
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

std::string plan_text(const ExposureFigures& figures) {
  std::string text = "plan: ";
  if (figures.blocks_read == 0) {
    text += "nothing is read: no gain within the capture differs from 0";
  } else {
    const auto [first, last] = figures.read;
    text += format("{} of {} samples have a gain that differs from 0; ", figures.live_samples,
                   figures.timeline.sample_count());
    text += format("read: {} (samples {} … {})", counted(figures.blocks_read, "block"), first, last - 1);
    if (figures.block_count) {
      text += format(", skipped: {}", counted(*figures.block_count - figures.blocks_read, "block"));
    } else if (last < figures.timeline.sample_count()) {
      text += format("; the clip is decoded up to there");
    }
  }
  const auto time = [](std::int64_t ns) { return integral_text(static_cast<double>(ns)); };
  for (std::size_t f = 0; f < std::min(figures.functions.size(), kFunctionsInSummary); ++f) {
    const PlannedFunction& function = figures.functions[f];
    const Interval& live = function.summary.live;
    text +=
        format("\n  M{}: {}, {}, {}", function.tag, counted(function.pixel_count, "pixel"),
               live.empty() ? "never live" : format("live {} … {}", time(live.begin_ns), time(live.end_ns)),
               counted(function.live.size(), "sample"));
  }
  if (figures.functions.size() > kFunctionsInSummary) {
    text += format("\n  and {} functions more", figures.functions.size() - kFunctionsInSummary);
  }
  return text + format("\n  tables of gains: {}; map of functions: {}", bytes_text(figures.table_bytes),
                       bytes_text(figures.map_bytes));
}

Json functions_json(const ExposureFigures& figures) {
  Json functions = Json::array();
  for (const PlannedFunction& function : figures.functions) {
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
