#include "app/output/exposure_report.hpp"

#include <algorithm>

#include "app/text/size_text.hpp"
#include "capture/format.hpp"

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

void add_saturation(Json& json, const Saturation& saturation, ValueType type) {
  if (!holds_codes(type)) return;
  json["saturated_below_pixels"] = saturation.below;
  json["saturated_above_pixels"] = saturation.above;
}

}  // namespace nutik::app
