// Errors in the words of the command line. Libraries say what is wrong, and hold the values; which option helps is
// said here.
#pragma once

#include <exception>
#include <string>

namespace nutik::app {

[[nodiscard]] std::string message_text(const std::exception& error);

}  // namespace nutik::app
