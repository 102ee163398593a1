#include "app/output/exposure_report.hpp"

#include <algorithm>

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

std::vector<std::string> exposure_warnings(const Exposed& exposed) {
  std::vector<std::string> warnings = exposed.plan.warnings;
  if (!holds_codes(exposed.picture.type)) return warnings;
  // Light below 0 is black in a picture of codes: a still scene under a negative still gain disappears.
  for (const PlannedFunction& function : exposed.plan.functions) {
    const double still_gain = function.summary.still_gain();
    if (still_gain >= 0.0) continue;
    warnings.push_back(
        format("M{}: the still gain is {:.6g}: whatever does not move comes out black; write a .pfm "
               "or a .tif with --depth float to keep light below 0",
               function.tag, still_gain));
  }
  return warnings;
}

}  // namespace nutik::app
