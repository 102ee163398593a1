// What somebody may have meant by a word that is not known.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace nutik {

// `; did you mean --exposure?` for the known words that `word` is the beginning of (at most four), else the
// nearest one where it is near enough, else nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace nutik
