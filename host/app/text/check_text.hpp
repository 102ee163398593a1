// What a check looked at and what it came to, as text and as JSON.
#pragma once

#include <string>

#include "app/output/report.hpp"
#include "session/making/input_check.hpp"

namespace nutik::app {

// A line on what was looked at.
[[nodiscard]] std::string heading_text(const InputCheck& check);
// A row for each function, without columns of what is not known. For at least one function.
[[nodiscard]] std::string figures_text(const InputCheck& check);

[[nodiscard]] Json check_json(const InputCheck& check);

}  // namespace nutik::app
