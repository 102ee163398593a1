// The files that a command reads.
#pragma once

#include <string>
#include <vector>

#include "app/command_line/options.hpp"

namespace nutik::app {

// Capture or clip (each still of a sequence on its own), mask and functions: what an output must not replace.
[[nodiscard]] std::vector<std::string> input_files(const Options& options);

}  // namespace nutik::app
