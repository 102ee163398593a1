// Completion for shells, from the one table of commands and options.
#pragma once

#include <string>
#include <string_view>

namespace nutik::app {

// A script for `bash`, `zsh` or `fish`, as each expects it. Throws UsageError for another shell.
[[nodiscard]] std::string completion_script(std::string_view shell);

}  // namespace nutik::app
