// What is said of an exposure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/output/json.hpp"
#include "session/exposed_picture.hpp"

namespace nutik::app {

// What to tell about an exposure, whole sentences: its warnings, and what codes cannot hold.
[[nodiscard]] std::vector<std::string> exposure_warnings(const ExposedPicture& exposed);

// `, still gain M0 1, M128 0.25`, or without a tag for a plain interval.
[[nodiscard]] std::string still_gains_text(const ExposureFigures& figures, bool plain);

// `, 12 pixels saturated below 0 and 3 above 1`, `, no pixel saturated`. Nothing where pictures hold
// light.
[[nodiscard]] std::string saturation_text(const Saturation& saturation, ValueType type);

// The same for scripts: `saturated_below_pixels`, `saturated_above_pixels`.
void add_saturation(Json& json, const Saturation& saturation, ValueType type);

// What an exposure reads and leaves out, and why, for -v: whole lines, without a line end behind the last.
[[nodiscard]] std::string plan_text(const ExposureFigures& figures);

// The functions for scripts.
[[nodiscard]] Json functions_json(const ExposureFigures& figures);

}  // namespace nutik::app
