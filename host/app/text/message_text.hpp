// Errors in the words of the command line. Libraries say what is wrong, and hold the values; which option helps is
// said here.
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "session/below/error.hpp"

namespace nutik::app {

[[nodiscard]] std::string message_text(const std::exception& error);
// What a setting is called here.
[[nodiscard]] std::string_view option_of(Setting setting);
// ` (--depth, --renderer)`: what settings are called here; empty if there are none.
[[nodiscard]] std::string options_text(const std::vector<Setting>& settings);
[[nodiscard]] std::vector<std::string> note_texts(const std::vector<Note>& notes);

}  // namespace nutik::app
