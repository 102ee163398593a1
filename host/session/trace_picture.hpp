// A trace as a picture: light, gain and their product under one another, on one time axis.
#pragma once

#include <span>
#include <string>

#include "capture/picture.hpp"
#include "render/output_format.hpp"
#include "render/trace.hpp"

namespace nutik {

// The exposure's light by channel: `0.2159  0.301  0.112`.
[[nodiscard]] std::string light_text(std::span<const Trace> traces);

// What that is as codes of a picture: `146 106 71`.
[[nodiscard]] std::string traced_codes(std::span<const Trace> traces, const CaptureFormat& capture,
                                       const OutputFormat& output);

// Draws the live interval, with a margin. `heading` says what was traced; 8-bit colour.
[[nodiscard]] Picture trace_picture(const Trace& trace, const PlannedFunction& function,
                                    const std::string& heading);

// Pictures of the same width, one under the other.
[[nodiscard]] Picture stacked(std::span<const Picture> pictures);

}  // namespace nutik
