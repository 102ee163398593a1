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

}  // namespace nutik::app
