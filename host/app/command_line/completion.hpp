// Completion for shells, which ask the program itself.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace nutik::app {

// A script for `bash`, `zsh` or `fish`, as each expects it: it calls `nutik-cl completion -- SHELL WORD...` and offers
// what that answers. Throws UsageError for another shell.
[[nodiscard]] std::string completion_script(std::string_view shell);

// How a command line may go on whose last word, which may be empty, is being typed. A line for each possibility:
//
//   encode<TAB>Turn a video …     a word, and what it is
//   :files                        any file
//   :files pgm|png                a file that ends so, or a folder
//
// Of --name=VALUE the value alone. Empty where nothing is known, or the words before make no sense.
[[nodiscard]] std::string completions(std::span<const std::string> words);

}  // namespace nutik::app
