// Words as a POSIX shell takes them.
#pragma once

#include <string>
#include <string_view>

namespace nutik::app {

// The word as it is where a shell takes it literally, else in single quotes.
[[nodiscard]] std::string shell_word(std::string_view word);

}  // namespace nutik::app
