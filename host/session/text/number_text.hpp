// Numbers as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/picture.hpp"
#include "capture/rational.hpp"
#include "capture/timeline.hpp"
#include "render/output_format.hpp"

namespace nutik {

// A whole number of low … high. Throws UsageError naming `what`.
[[nodiscard]] std::uint32_t parse_whole_number(std::string_view text, std::string_view what,
                                               std::uint32_t low, std::uint32_t high);

// Two of them with something between: `16x9`, `320,180`. Throws UsageError with `otherwise` where that is not there.
struct WholeNumber {
  std::string_view what;
  std::uint32_t low, high;
};
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_pair(std::string_view text, char between,
                                                                 const WholeNumber& first,
                                                                 const WholeNumber& second,
                                                                 const std::string& otherwise);

// A finite decimal number; empty where the text is none.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
// One of low … high. Throws UsageError naming `what`.
[[nodiscard]] double parse_number(std::string_view text, std::string_view what, double low, double high);

// A number of bytes: 3, 500MB, 2g, 1GiB. Empty where the text is none, or more than 64 bits hold.
[[nodiscard]] std::optional<std::uint64_t> parse_bytes(std::string_view text);

// Numbers between commas: `10,20.5,-3`. Throws UsageError naming the option and the part that is none.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, std::string_view option);

// Sizes for people.

[[nodiscard]] std::string counted(std::uint64_t count, std::string_view name);  // `1 block`, `2 blocks`
[[nodiscard]] std::string percent_text(std::uint64_t part, std::uint64_t whole);  // `12.5 %`
// `12 pixels saturated below 0 and 3 above 1`, `no pixel below 0 or above 1`.
[[nodiscard]] std::string saturated_text(const Saturation& saturation);
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);  // `94 kB`, `1.49 GB`
[[nodiscard]] std::string shape_text(const Shape& shape);   // `640 x 480 colour`

// `32:27`
[[nodiscard]] std::string aspect_text(const Rational& aspect);

// Lengths of time for people.

// `12.5 ms`, `1.25 s`, `36 h`, `800 days`, `30 years`: a length, with up to four digits.
[[nodiscard]] std::string duration_text(std::int64_t nanoseconds);

// `300 samples a second`, `a sample every 3600 s`: `name` is what they are.
[[nodiscard]] std::string rate_text(const Rational& rate, std::string_view name);

// `960 pictures a second`; of times that follow no rate `irregular times, 384.6 pictures a second on average`.
[[nodiscard]] std::string rate_text(const Timeline& timeline);

// `750 ms`, `-1.01 s`, `42 days`: a time, or the integral of a gain over time, with up to six digits.
[[nodiscard]] std::string integral_text(double nanoseconds);

}  // namespace nutik
