// The rows of the option table.
#pragma once

#include <vector>

#include "app/command_line/option_table.hpp"

namespace nutik::app {

// Heading by heading, as help shows them.
[[nodiscard]] std::vector<Option> option_rows();

}  // namespace nutik::app
