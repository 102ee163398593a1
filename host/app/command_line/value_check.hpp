// Values that cannot be what an option takes, before anything is done with them.
#pragma once

#include <string>
#include <string_view>

#include "session/schema/option.hpp"

namespace nutik::app {

// Throws UsageError where a value is most likely another word of the command line, or a mistyped one of the
// option's choices: an option's name, a file for a number, a capture for functions. What it lets pass is for
// whoever reads the value to judge. `name` is the option as it was written.
void check_value(const Option& option, const std::string& name, const std::string& value);

// Throws UsageError where a value is most likely a mistyped one of the option's choices; `what` says what it is.
void check_choice(std::string_view what, const std::string& value, const Option& option);

}  // namespace nutik::app
