// Numbers that have more digits than are read.
#pragma once

#include <string_view>

namespace nutik {

// Whether a text is a decimal number, of a time with its unit, that Rational::read() and StatedTime::read() have too few
// digits for, 15.
[[nodiscard]] bool has_too_many_digits(std::string_view text);

}  // namespace nutik
