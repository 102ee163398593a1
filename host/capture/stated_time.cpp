#include "capture/stated_time.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"

namespace nutik {
namespace {

struct Unit {
  std::string_view name;
  std::int64_t nanoseconds;
};

// The first of a length is the one that is written; times are written in those up to a second, the coarsest first.
constexpr std::array<Unit, 9> kUnits{{{"s", 1'000'000'000},
                                      {"ms", 1'000'000},
                                      {"us", 1000},
                                      {"\u00B5s", 1000},
                                      {"\u03BCs", 1000},
                                      {"ns", 1},
                                      {"min", 60'000'000'000},
                                      {"h", 3'600'000'000'000},
                                      {"f", 0}}};

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

// The last characters that are a unit's name.
const Unit* unit_of(std::string_view text) {
  const Unit* longest = nullptr;
  for (const Unit& unit : kUnits) {
    if (text.ends_with(unit.name) && (longest == nullptr || unit.name.size() > longest->name.size()))
      longest = &unit;
  }
  return longest;
}

// `1:02:03.5`, without its sign, in seconds.
std::optional<Rational> read_clock(std::string_view text) {
  const std::string_view decimals = text.substr(std::min(text.find('.'), text.size()));
  if (decimals.size() > 1 && !is_digits(decimals.substr(1))) return std::nullopt;
  std::int64_t seconds = 0;
  std::string_view whole = text.substr(0, text.size() - decimals.size());
  bool is_over = false;
  for (int parts = 0; !is_over; ++parts) {
    const std::size_t colon = std::min(whole.find(':'), whole.size());
    is_over = colon == whole.size();
    const std::string_view part = whole.substr(0, colon);
    if (!is_digits(part) || part.size() > 6 || parts > 2) return std::nullopt;
    const std::int64_t value = *parsed<std::int64_t>(part);
    if (parts > 0 && (part.size() != 2 || value > 59)) return std::nullopt;
    seconds = seconds * 60 + value;
    whole.remove_prefix(std::min(colon + 1, whole.size()));
  }
  return Rational::read(format("{}{}", seconds, decimals));
}

}  // namespace

bool has_too_many_digits(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (const Unit* const unit = unit_of(text)) text.remove_suffix(unit->name.size());
  const std::size_t mark = std::min(text.find_first_of("eE"), text.size()), point = std::min(text.find('.'), mark);
  std::string digits(text.substr(0, point));
  if (point < mark) digits += text.substr(point + 1, mark - point - 1);
  if (mark < text.size()) {
    const bool is_signed = text.find_first_of("+-", mark) == mark + 1;
    if (!is_digits(text.substr(mark + (is_signed ? 2 : 1)))) return false;
  }
  return is_digits(digits) && !Rational::read(text);
}

std::optional<StatedTime> StatedTime::read(std::string_view text) {
  const std::string_view behind_sign = text.substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0);
  if (behind_sign.find_first_of(".0123456789") != 0) return std::nullopt;
  const auto signed_by = [&](std::optional<Rational> number, std::int64_t unit_ns) -> std::optional<StatedTime> {
    if (!number) return std::nullopt;
    if (text[0] == '-') number->numerator = -number->numerator;
    return StatedTime{*number, unit_ns};
  };
  if (behind_sign.find(':') != behind_sign.npos) return signed_by(read_clock(behind_sign), kSecondNs);
  const Unit* const unit = unit_of(behind_sign);
  if (unit == nullptr) {
    const bool is_fraction = behind_sign.find('/') != behind_sign.npos;
    return is_fraction ? signed_by(Rational::read(behind_sign), kSecondNs) : std::nullopt;
  }
  const std::string_view number = behind_sign.substr(0, behind_sign.size() - unit->name.size());
  // Nanoseconds of a long capture have more digits than other numbers may.
  if (unit->nanoseconds == 1 && is_digits(number)) {
    const auto whole = parsed<std::int64_t>(number);
    return whole ? signed_by(Rational{*whole, 1}, 1) : std::nullopt;
  }
  return signed_by(Rational::read(number), unit->nanoseconds);
}

StatedTime StatedTime::parse(std::string_view text, std::string_view what, bool may_count) {
  const std::optional<StatedTime> time = read(text);
  if (const std::string_view hint = decimal_mark_hint(text); !time && !hint.empty())
    throw UsageError(format("{} '{}' is no time{}", what, text, hint));
  if (!time && has_too_many_digits(text))
    throw UsageError(format("{} '{}' needs more than 15 digits; write fewer", what, text));
  if (!time) {
    throw UsageError(
        format("{} '{}' is no time; write a number and a unit: 0.4s, 10ms, 250us, 1/100s{}", what, text,
               may_count ? ", 0:01.5, or 37f for pictures of the clip" : " or 0:01.5"));
  }
  if (time->counts_samples() && !may_count) {
    throw UsageError(format("{} '{}' counts pictures, which are no length of time; write seconds, 15ms or 1/24s", what,
                            text));
  }
  if (time->is_longest()) throw UsageError(format("{} '{}' is longer than 126 years", what, text));
  return *time;
}

bool StatedTime::is_longest() const {
  const int128 magnitude = static_cast<int128>(number.numerator < 0 ? -number.numerator : number.numerator) * unit_ns;
  return magnitude > static_cast<int128>(kLargestTimeNs) * number.denominator;
}

std::int64_t StatedTime::nanoseconds() const {
  const ExactTime exact = exact_nanoseconds();
  return round_half_up(exact.numerator, exact.denominator);
}

Rational StatedTime::modest_nanoseconds() const {
  constexpr int128 kMax = 999'999'999'999'999;
  constexpr std::int64_t kFinest = 999'999;
  const std::int64_t shared = std::gcd(unit_ns, number.denominator);
  const int128 above = static_cast<int128>(number.numerator) * (unit_ns / shared);
  const std::int64_t below = number.denominator / shared;
  if (above > kMax || above < -kMax || below > kFinest) return {nanoseconds(), 1};
  return {static_cast<std::int64_t>(above), below};
}

StatedTime StatedTime::of_nanoseconds(std::int64_t nanoseconds) {
  const auto unit = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& candidate) {
    return candidate.nanoseconds > 0 && nanoseconds % candidate.nanoseconds == 0;
  });
  return {{nanoseconds / unit->nanoseconds, 1}, unit->nanoseconds};
}

StatedTime StatedTime::of(const ExactTime& time) {
  constexpr int128 kLargest = 999'999'999'999'999;  // Rational::parse() reads no more digits
  if (time.denominator == 1) return of_nanoseconds(static_cast<std::int64_t>(time.numerator));
  const auto shared =
      static_cast<std::int64_t>(std::gcd(static_cast<std::int64_t>(time.numerator % kSecondNs), kSecondNs));
  const int128 above = time.numerator / shared, below = time.denominator * (kSecondNs / shared);
  if (above <= kLargest && above >= -kLargest && below <= kLargest)
    return {Rational::of(static_cast<std::int64_t>(above), static_cast<std::int64_t>(below)), kSecondNs};
  if (time.numerator <= kLargest && time.numerator >= -kLargest)
    return {
        Rational::of(static_cast<std::int64_t>(time.numerator), static_cast<std::int64_t>(time.denominator)),
        1};
  return of_nanoseconds(round_half_up(time.numerator, time.denominator));
}

std::string StatedTime::text() const {
  const auto unit = std::ranges::find(kUnits, unit_ns, &Unit::nanoseconds);
  return format("{}{}", number.text(), unit->name);
}

bool operator==(const StatedTime& a, const StatedTime& b) {
  if (a.counts_samples() != b.counts_samples()) return false;
  if (a.counts_samples()) return a.number == b.number;
  // Both in lowest terms, in nanoseconds: products of the terms themselves could leave 128 bits.
  const auto lowest = [](const StatedTime& time) {
    const std::int64_t shared = std::gcd(time.unit_ns, time.number.denominator);
    return std::pair(static_cast<int128>(time.number.numerator) * (time.unit_ns / shared),
                     time.number.denominator / shared);
  };
  return lowest(a) == lowest(b);
}

}  // namespace nutik
