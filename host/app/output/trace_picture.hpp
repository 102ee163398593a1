// A trace as a picture: light, gain and their product under one another, on one time axis.
#pragma once

#include <string>

#include "session/capture.hpp"
#include "session/session.hpp"

namespace nutik::app {

// Of the live interval, with a margin. `heading` says what was traced; 8-bit colour.
[[nodiscard]] Picture trace_picture(const Trace& trace, const PlannedFunction& function,
                                    const std::string& heading);

}  // namespace nutik::app
