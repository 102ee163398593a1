// A series of exposures of one capture: `expose` with --every.
#pragma once

#include "app/command_line/options.hpp"

namespace nutik::app {

// Returns the exit status; errors are thrown.
int expose_series(const Options& options);

}  // namespace nutik::app
