// Numbers that have more digits than are read.
#pragma once

#include <string_view>

namespace nutik {

// Whether a text is a decimal number, of a time with its unit, for which the 15 digits of Rational::read() and
// StatedTime::read() are too few.
[[nodiscard]] bool has_too_many_digits(std::string_view text);

}  // namespace nutik
