// The manual page, from the one table of commands and options.
#pragma once

#include <string>

namespace nutik::app {

// In the language of man(7), ASCII only.
[[nodiscard]] std::string man_page();

}  // namespace nutik::app
