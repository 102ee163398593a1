// Lists and tables for people, and what somebody may have meant by a word that is not known.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/text.hpp"

namespace nutik {

// How many columns of a terminal a text takes: bytes that continue a UTF-8 character take none.
[[nodiscard]] std::size_t columns(std::string_view text);

// `; did you mean --exposure?` for the known words that `word` is the beginning of (at most four), else the
// nearest one where it is near enough, else nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> known);

// Rows of equal length, the first the heading; a letter of `alignment` for each column: l or r. Lines
// without blanks at their ends and without a line end behind the last.
[[nodiscard]] std::string table_text(const std::vector<std::vector<std::string>>& rows,
                                     std::string_view alignment);

}  // namespace nutik
