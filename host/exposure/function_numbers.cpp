#include "exposure/function_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "capture/stated_time.hpp"
#include "capture/text.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {
namespace {

bool is_decimal(char c) { return c >= '0' && c <= '9'; }
bool is_sign(char c) { return c == '+' || c == '-'; }

std::size_t digits_at(std::string_view text, std::size_t at) {
  const auto begin = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return static_cast<std::size_t>(std::find_if_not(begin, text.end(), is_decimal) - begin);
}

// [+-] digits [. digits] [e [+-] digits], with a digit before or after the point.
struct Decimal {
  bool is_negative = false;
  std::string_view whole, fraction, exponent;  // digits; the exponent with its sign
  std::size_t length = 0;
};

// The longest decimal number that a word starts with.
std::optional<Decimal> decimal_at_start(std::string_view word) {
  Decimal decimal;
  std::size_t at = !word.empty() && is_sign(word[0]) ? 1 : 0;
  decimal.is_negative = at == 1 && word[0] == '-';
  decimal.whole = word.substr(at, digits_at(word, at));
  at += decimal.whole.size();
  if (at < word.size() && word[at] == '.') {
    decimal.fraction = word.substr(at + 1, digits_at(word, at + 1));
    at += 1 + decimal.fraction.size();
  }
  if (decimal.whole.empty() && decimal.fraction.empty()) return std::nullopt;
  if (at < word.size() && (word[at] == 'e' || word[at] == 'E')) {
    const std::size_t sign = at + 1 < word.size() && is_sign(word[at + 1]) ? 1 : 0;
    const std::size_t digits = digits_at(word, at + 1 + sign);
    if (digits > 0) {
      decimal.exponent = word.substr(at + 1, sign + digits);
      at += 1 + sign + digits;
    }
  }
  decimal.length = at;
  return decimal;
}

bool is_decimal(std::string_view word) {
  const auto decimal = decimal_at_start(word);
  return decimal && decimal->length == word.size();
}

long exponent_of(std::string_view digits) {
  constexpr long kBeyondAnyWord = 1'000'000'000'000;
  const long exponent = std::strtol(std::string(digits).c_str(), nullptr, 10);
  return std::clamp(exponent, -kBeyondAnyWord, kBeyondAnyWord);
}

// decimal · 10^power, where that is a whole number that a time may be.
std::optional<std::int64_t> whole_number(const Decimal& decimal, long power) {
  std::string digits = std::string(decimal.whole).append(decimal.fraction);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  if (digits.empty()) return 0;
  power += exponent_of(decimal.exponent) - static_cast<long>(decimal.fraction.size());
  for (; power < 0 && digits.back() == '0'; ++power) digits.pop_back();
  if (power < 0 || power > 18 || digits.size() > 19) return std::nullopt;
  digits.append(static_cast<std::size_t>(power), '0');
  const auto value = parsed<std::int64_t>(digits);
  if (!value || *value > kLargestTimeNs) return std::nullopt;
  return decimal.is_negative ? -*value : *value;
}

// What to write for a time that is written in another way, as far as it can be guessed.
std::string time_way_out(std::string_view word) {
  if (const auto decimal = decimal_at_start(word); decimal && decimal->length == word.size()) {
    // Few people think in fractions of a nanosecond.
    if (decimal->exponent.empty()) return format("is it {0}s, or {0}ms?", shown(word));
    if (const auto whole = whole_number(*decimal, 0)) return format("write {}", *whole);
  }
  return "as in 10000000, 10ms, 0.4s, 1/30s or 0:01.5";
}

// The nearest double: 0 for what is too small, infinity for what is too large.
double to_double(std::string_view written) {
  if (written.starts_with('+')) written.remove_prefix(1);
  double value = 0;
  const auto error = std::from_chars(written.data(), written.data() + written.size(), value).ec;
  if (error != std::errc::result_out_of_range) return value;
  // from_chars does not tell the two apart. The decimal exponent of the first digit that is not 0
  // does.
  const auto first = written.find_first_of("123456789");
  const auto mark = std::min(written.find_first_of("eE"), written.size());
  const auto point = std::min(written.find('.'), mark);
  const long exponent = mark < written.size() ? exponent_of(written.substr(mark + 1)) : 0;
  const long place = static_cast<long>(point) - static_cast<long>(first);
  return exponent > -place ? HUGE_VAL : std::copysign(0.0, written.starts_with('-') ? -1.0 : 1.0);
}

// inf, infinity, nan and nan(…), in capitals or not.
bool is_infinity_or_nan(std::string_view word) {
  if (!word.empty() && is_sign(word[0])) word.remove_prefix(1);
  const auto starts_like = [&](std::string_view name) {
    return word.size() >= name.size() &&
           std::equal(name.begin(), name.end(), word.begin(),
                      [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
  };
  return (word.size() == 3 && (starts_like("inf") || starts_like("nan"))) ||
         (word.size() == 8 && starts_like("infinity")) || starts_like("nan(");
}

// So many pictures; nothing where that is further than kLargestTimeNs.
std::optional<std::int64_t> pictures_ns(const Rational& count, const StatedTime& picture) {
  const Rational each = picture.modest_nanoseconds();
  const int128 above = static_cast<int128>(count.numerator) * each.numerator;
  const int128 below = static_cast<int128>(count.denominator) * each.denominator;
  const int128 magnitude = above < 0 ? -above : above, whole = magnitude / below;
  if (whole > kLargestTimeNs || (whole == kLargestTimeNs && magnitude % below != 0)) return std::nullopt;
  return round_half_up(above, below);
}

}  // namespace

ReadNumber<std::uint8_t> read_mask_value(std::string_view word) {
  if (digits_at(word, 0) < word.size()) {
    return {0, format("'M{}' is no mask value; write M and a whole number 0 … 255", shown(word))};
  }
  unsigned value = 0;
  for (const char digit : word) value = std::min(value * 10 + static_cast<unsigned>(digit - '0'), 1000u);
  if (value > 255) {
    return {0, format("mask value {} is above 255, the largest an 8-bit mask has", shown(word))};
  }
  return {static_cast<std::uint8_t>(value), {}};
}

ReadNumber<std::int64_t> read_time(std::string_view word, const std::optional<StatedTime>& picture) {
  const std::size_t sign = !word.empty() && is_sign(word[0]) ? 1 : 0;
  const std::size_t digits = digits_at(word, sign);
  const bool is_plain = digits > 0 && sign + digits == word.size();
  const auto stated = is_plain ? std::nullopt : StatedTime::read(word);
  const bool counts = stated && stated->counts_samples();
  if (counts && !picture) {
    return {0, format("{} counts pictures; a line before it says how long one is: 1f = 1/240s", quoted(word))};
  }
  if (!is_plain && !stated && word.find(';') != word.npos)
    return {0, format("{} is no time; between time and gain stands a colon", quoted(word))};
  if (!is_plain && !stated && !is_decimal(word) && has_too_many_digits(word))
    return {0, format("{} needs more than 15 digits; write fewer", quoted(word))};
  if (!is_plain && !stated) {
    return {0, format("{} is no time; write whole nanoseconds, or a unit behind the number: {}", quoted(word),
                      time_way_out(word))};
  }
  const auto value = is_plain               ? whole_number(*decimal_at_start(word), 0)
                     : counts               ? pictures_ns(stated->number, *picture)
                     : stated->is_longest() ? std::nullopt
                                            : std::optional(stated->nanoseconds());
  if (!value) {
    return {0,
            format("time {} is further than {} ns from the start (126 years)", shown(word), kLargestTimeNs)};
  }
  return {*value, {}};
}

ReadNumber<StatedTime> read_picture_length(std::string_view word) {
  const bool is_plain = digits_at(word, 0) == word.size();
  const auto stated = StatedTime::read(is_plain ? std::string(word).append("ns") : word);
  const bool is_length = stated && !stated->counts_samples() && stated->number.numerator > 0;
  if (is_length && !stated->is_longest()) {
    const Rational each = stated->modest_nanoseconds();
    const ExactTime exact = stated->exact_nanoseconds();
    // So many digits that multiples stay exact.
    if (exact.numerator * each.denominator == exact.denominator * each.numerator) return {*stated, {}};
    return {{}, format("{} has too many digits for times that are multiples of it; write it as in 1001/30000s",
                       quoted(word))};
  }
  return {{}, format("{} is no length of a picture; write a time, as in 1f = 1/240s or 1f = 40ms", quoted(word))};
}

ReadNumber<double> read_gain(std::string_view word) {
  if (!is_decimal(word) && !is_infinity_or_nan(word)) {
    const bool has_other_minus = word.starts_with("\u2212") || word.starts_with("\u2013");
    return {0, format("{} is no gain; write {}", quoted(word),
                      has_other_minus ? "the minus as the - of the keyboard"
                                      : "a number such as 1, -0.5 or 2e-3")};
  }
  const double gain = is_decimal(word) ? to_double(word) : HUGE_VAL;
  if (!std::isfinite(gain)) {
    return {0, format("gain {} is not finite; gains are numbers up to 1.79e308", shown(word))};
  }
  return {gain, {}};
}

}  // namespace nutik
