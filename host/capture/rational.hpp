// Exact fractions for rates, shutter angles and times as people write them, so that a time is rounded
// once, from the exact value, and never drifts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace nutik {

inline constexpr std::int64_t kSecondNs = 1'000'000'000;
// No time lies further from the start of a capture (126 years), so that differences of times fit.
inline constexpr std::int64_t kLargestTimeNs = 4'000'000'000'000'000'000;

__extension__ typedef __int128 int128;

// A fraction in lowest terms. denominator > 0.
struct Rational {
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;

  // `numerator / denominator` in lowest terms. Throws UsageError where the denominator is 0.
  static Rational of(std::int64_t numerator, std::int64_t denominator);

  // Reads `30000/1001`, `29.97` (exactly 2997/100), `120` or `1e-3`; a leading minus is allowed. Nothing where the text
  // is none of these or needs more than 15 digits.
  static std::optional<Rational> read(std::string_view text);
  // The same. Throws UsageError naming `what` ("frame rate").
  static Rational parse(std::string_view text, std::string_view what);

  [[nodiscard]] double value() const {
    return static_cast<double>(numerator) / static_cast<double>(denominator);
  }

  // `30000/1001`, `120`, or the decimal form where that is exact within six places: `29.97`.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const Rational&, const Rational&) = default;
};

// What is wrong with `29,97`; empty of any other text.
[[nodiscard]] std::string_view decimal_mark_hint(std::string_view text);

// Whether a text is a decimal number, of a time with its unit, for which the 15 digits of Rational::read() and
// StatedTime::read() are too few.
[[nodiscard]] bool has_too_many_digits(std::string_view text);

// numerator / denominator rounded to the nearest whole number, halves upward. denominator > 0.
std::int64_t round_half_up(int128 numerator, int128 denominator);

}  // namespace nutik
