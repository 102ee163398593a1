// Numbers as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

// Numbers between commas: `10,20.5,-3`. Throws UsageError naming `what` and the part that is none.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, std::string_view what);

}  // namespace nutik
