// Lengths of time for people.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "capture/rational.hpp"
#include "capture/timeline.hpp"

namespace nutik {

// `12.5 ms`, `1.25 s`, `36 h`, `800 days`, `30 years`: a length, with up to four digits.
[[nodiscard]] std::string duration_text(std::int64_t nanoseconds);

// `300 samples a second`, `a sample every 3600 s`: `name` is what they are.
[[nodiscard]] std::string rate_text(const Rational& rate, std::string_view name);

// `960 pictures a second`; of times that follow no rate `irregular times, 384.6 pictures a second on average`.
[[nodiscard]] std::string rate_text(const Timeline& timeline);

// `750 ms`, `-1.01 s`, `42 days`: a time, or the integral of a gain over time, with up to six digits.
[[nodiscard]] std::string integral_text(double nanoseconds);

}  // namespace nutik
