// What is said of an exposure.
#pragma once

#include <string>

#include "capture/picture.hpp"
#include "render/render_plan.hpp"

namespace nutik::app {

// `, still gain M0 1, M128 0.25`, or without a tag for a plain interval.
[[nodiscard]] std::string still_gains_text(const RenderPlan& plan, bool plain);

// Light below 0 is black in a picture of codes: a still scene under a negative still gain disappears.
void warn_of_negative_gains(const RenderPlan& plan, ValueType type);

}  // namespace nutik::app
