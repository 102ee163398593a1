#include "capture/rational.hpp"

#include <algorithm>
#include <numeric>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::int64_t kLargest = 999'999'999'999'999;  // 15 digits: products of two fit 128 bits

// `e-3` behind a decimal: moves its point. Returns false where it is anything else, or more than 15 places away.
bool read_exponent(std::string_view text, std::int64_t& digits, std::int64_t& scale) {
  constexpr std::int64_t kMaxPlaces = 15;
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  std::int64_t places = 0;
  for (const char c : text) {
    if (c < '0' || c > '9' || places > kMaxPlaces) return false;
    places = places * 10 + (c - '0');
  }
  if (text.empty() || places > kMaxPlaces) return false;
  std::int64_t& grows = is_negative ? scale : digits;
  std::int64_t& shrinks = is_negative ? digits : scale;
  for (; places > 0; --places) {
    if (shrinks % 10 == 0) {
      shrinks /= 10;
    } else if (grows > kLargest / 10) {
      return false;
    } else {
      grows *= 10;
    }
  }
  return true;
}

// Digits, with at most one point when `allow_point`. Returns false where the text is anything else.
bool read_decimal(std::string_view text, bool allow_point, std::int64_t& digits, std::int64_t& scale) {
  digits = 0;
  scale = 1;
  bool any = false;
  bool point = false;
  for (const char c : text) {
    if (c == '.' && allow_point && !point) {
      point = true;
      continue;
    }
    if (c < '0' || c > '9') return false;
    if (digits > (kLargest - 9) / 10 || (point && scale > kLargest / 10)) return false;
    digits = digits * 10 + (c - '0');
    if (point) scale *= 10;
    any = true;
  }
  return any;
}

}  // namespace

Rational Rational::of(std::int64_t numerator, std::int64_t denominator) {
  if (denominator == 0) throw UsageError("a fraction's denominator cannot be 0");
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  const std::int64_t divisor = std::gcd(numerator, denominator);
  return {numerator / divisor, denominator / divisor};
}

std::optional<Rational> Rational::read(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  std::int64_t top = 0, top_scale = 1, bottom = 1, bottom_scale = 1;
  const auto slash = text.find('/');
  const auto exponent = slash == std::string_view::npos ? text.find_first_of("eE") : slash;
  bool good = read_decimal(text.substr(0, exponent), slash == std::string_view::npos, top, top_scale);
  if (good && exponent != slash) good = read_exponent(text.substr(exponent + 1), top, top_scale);
  if (good && slash != std::string_view::npos) {
    good = read_decimal(text.substr(slash + 1), false, bottom, bottom_scale) && bottom != 0;
  }
  if (!good) return std::nullopt;
  return of(negative ? -top : top, slash == std::string_view::npos ? top_scale : bottom);
}

Rational Rational::parse(std::string_view text, std::string_view what) {
  const std::optional<Rational> number = read(text);
  if (number) return *number;
  if (has_too_many_digits(text))
    throw UsageError(format("{} '{}' needs more than 15 digits; write fewer, or a fraction", what, text));
  throw UsageError(format("{} '{}' is not a number; write 180, 29.97 or 30000/1001 (15 digits at most){}", what, text,
                          decimal_mark_hint(text)));
}

std::string_view decimal_mark_hint(std::string_view text) {
  const bool is_one = text.find('.') == text.npos && std::ranges::count(text, ',') == 1;
  return is_one ? "; the decimal mark is a point" : "";
}

std::string Rational::text() const {
  if (denominator == 1) return format("{}", numerator);
  std::int64_t scale = 1;
  for (int places = 1; places <= 6 && denominator > 0; ++places) {
    scale *= 10;
    if (scale % denominator != 0) continue;
    const int128 scaled = static_cast<int128>(numerator) * (scale / denominator);
    const auto magnitude = static_cast<std::int64_t>(scaled < 0 ? -scaled : scaled);
    return format("{}{}.{:0{}}", numerator < 0 ? "-" : "", magnitude / scale, magnitude % scale, places);
  }
  return format("{}/{}", numerator, denominator);
}

std::int64_t round_half_up(int128 numerator, int128 denominator) {
  const int128 doubled = 2 * numerator + denominator;
  int128 quotient = doubled / (2 * denominator);
  if (doubled % (2 * denominator) < 0) --quotient;  // C++ truncates toward zero; this is a floor
  return static_cast<std::int64_t>(quotient);
}

}  // namespace nutik
