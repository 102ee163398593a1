// What a function comes to by itself, wherever pixels' delays put it: over the capture's domain, made longer so that it
// holds all of the function's control points.
//
// A delayed exposure has its D and its normalization from here (docs/explanation/model.md, "Time maps"). For a function
// that lies within the capture they are those of an exposure without delays.
#pragma once

#include <cstdint>

#include "exposure/gain_function.hpp"

namespace nutik {

[[nodiscard]] Interval whole_course(const GainFunction& function, std::int64_t duration_ns);

// As summarize(), over that; so no part lies outside.
[[nodiscard]] GainSummary summarize_course(const GainFunction& function, std::int64_t duration_ns);

}  // namespace nutik
