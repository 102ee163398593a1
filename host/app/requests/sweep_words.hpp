// What the options vary in a sweep.
#pragma once

#include "app/command_line/options.hpp"
#include "session/sweep_request.hpp"

namespace nutik::app {

// One or two ranges in the order of the command line. Throws UsageError where there is none, there are three, or a
// range is empty or makes more pictures than a sheet holds.
[[nodiscard]] SweepRequest sweep_request(const Options& options);

}  // namespace nutik::app
