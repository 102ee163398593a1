// What is said of an exposure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/output/json.hpp"
#include "render/render_plan.hpp"
#include "render/renderer.hpp"

namespace nutik::app {

// `, still gain M0 1, M128 0.25`, or without a tag for a plain interval.
[[nodiscard]] std::string still_gains_text(const RenderPlan& plan, bool plain);

// `, 12 pixels saturated below 0 and 3 above 1`, `, no pixel saturated`. Nothing where pictures hold
// light.
[[nodiscard]] std::string saturation_text(const Saturation& saturation, ValueType type);

// The same for scripts: `saturated_below_pixels`, `saturated_above_pixels`.
void add_saturation(Json& json, const Saturation& saturation, ValueType type);

// What an exposure reads and leaves out, and why, for -v: whole lines, without a line end behind the last. Blocks of
// a clip are counted as they are made, so `block_count` is none there.
[[nodiscard]] std::string plan_text(const RenderPlan& plan, const Timeline& timeline,
                                    std::optional<std::uint64_t> block_count);

// The plan's functions for scripts.
[[nodiscard]] Json functions_json(const RenderPlan& plan);

}  // namespace nutik::app
