// Words as a POSIX shell takes them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nutik {

// The word as it is where a shell takes it literally, else in single quotes; what cannot be seen, in octal numbers.
[[nodiscard]] std::string shell_word(std::string_view word);

// A file's name such that no command takes it for an option: `./-clip.mp4`. `-` stays what it is.
[[nodiscard]] std::string not_an_option(std::string_view name);

// The words of a line, without their quotes and backslashes; nothing else has a meaning. Throws UsageError where a
// quote is not closed.
[[nodiscard]] std::vector<std::string> shell_words(std::string_view line);

}  // namespace nutik
