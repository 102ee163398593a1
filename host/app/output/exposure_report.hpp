// What is said of an exposure.
#pragma once

#include <string>
#include <vector>

#include "app/input/exposer.hpp"
#include "render/render_plan.hpp"

namespace nutik::app {

// `, still gain M0 1, M128 0.25`, or without a tag for a plain interval.
[[nodiscard]] std::string still_gains_text(const RenderPlan& plan, bool plain);

// What to tell about an exposure, whole sentences: the plan's warnings, and what codes cannot hold.
[[nodiscard]] std::vector<std::string> exposure_warnings(const Exposed& exposed);

}  // namespace nutik::app
