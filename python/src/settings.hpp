// What is stated by name, as the schema's options. Values are words, as on the command line.
#pragma once

#include <map>
#include <string>

#include "features/schema/command_id.hpp"
#include "features/schema/options.hpp"

namespace nutik::python {

// By the names of Python's arguments.
using Settings = std::map<std::string, std::string>;

// As a command's options. Throws UsageError.
[[nodiscard]] Options stated_options(CommandId command, const Settings& settings);

}  // namespace nutik::python
