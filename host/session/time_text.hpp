// Lengths of time for people.
#pragma once

#include <cstdint>
#include <string>

namespace nutik {

// `12.5 ms`, `1.25 s`: a length, with up to four digits.
[[nodiscard]] std::string duration_text(std::int64_t nanoseconds);

// `750 ms`, `-1.01 s`: a time, or the integral of a gain over time, with up to six digits.
[[nodiscard]] std::string integral_text(double nanoseconds);

}  // namespace nutik
