// Gain functions as text: what parse_functions() reads back, identically.
#pragma once

#include <cstdint>
#include <string>

#include "exposure/gain_function.hpp"

namespace nutik {

// The function with each jump as a step of 1 ns, for function files know no jumps. The step is taken from
// where the magnitude is smaller, so that what is fully exposed stays so: before the jump where the gain
// grows, behind it where it shrinks: a jump at the capture's start begins 1 ns before it, so that the function can be
// moved as a whole. Throws UsageError where control points stand too close for a step.
[[nodiscard]] GainFunction with_steps(const GainFunction& function);

// `M128 [399999999:0], [400000000:1], [410000000:1], [410000001:0]`, with steps for jumps. Gains have as many
// digits as it takes to read the same double back.
[[nodiscard]] std::string function_text(std::uint8_t tag, const GainFunction& function);

}  // namespace nutik
