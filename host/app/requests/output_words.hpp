// What --depth and --negative ask of a picture.
#pragma once

#include "app/command_line/options.hpp"
#include "session/output_request.hpp"

namespace nutik::app {

// Throws UsageError where a value is not known.
[[nodiscard]] OutputRequest output_request(const Options& options);

}  // namespace nutik::app
