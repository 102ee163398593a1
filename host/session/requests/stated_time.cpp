#include "session/requests/stated_time.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "session/text/number_text.hpp"

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

constexpr std::int64_t kLongestNs = 4'000'000'000'000'000'000;

// The number of a picture that the timeline has.
std::uint64_t existing_sample(std::int64_t sample, const Timeline& timeline) {
  const auto count = static_cast<std::int64_t>(timeline.sample_count());
  if (sample < 0 || sample >= count) {
    throw UsageError(
        format("picture {} is outside the capture, which has {} (0f … {}f)", sample, count, count - 1));
  }
  return static_cast<std::uint64_t>(sample);
}

std::int64_t whole_samples(const StatedTime& time, std::string_view what) {
  if (time.number.denominator != 1) {
    throw UsageError(format("{} {}f is not a whole number of pictures", what, time.number.text()));
  }
  return time.number.numerator;
}

std::int64_t rounded(const ExactTime& time) { return round_half_up(time.numerator, time.denominator); }

[[noreturn]] void refuse_length(const StatedTime& length, std::string_view why) {
  throw UsageError(format("exposure '{}' is {}", length.text(), why));
}

// GainFunction could not hold later times than the longest.
Exposure checked(Exposure interval, const StatedTime& length) {
  if (interval.end_ns <= interval.start_ns) refuse_length(length, "shorter than a nanosecond");
  interval.end_ns = std::min(interval.end_ns, std::max(kLongestNs, interval.start_ns));
  return interval;
}

}  // namespace

ExactTime periods_from(std::int64_t time_ns, std::int64_t count, const Timeline& timeline) {
  const std::uint64_t first = sample_at(time_ns, timeline);
  const std::uint64_t last = existing_sample(static_cast<std::int64_t>(first) + count - 1, timeline);
  if (timeline.is_constant()) return ExactTime::of_sample(timeline, static_cast<std::uint64_t>(count));
  const bool at_end = last + 1 == timeline.sample_count();
  return {(at_end ? timeline.duration_ns() : timeline.start_ns(last + 1)) - timeline.start_ns(first), 1};
}

StatedTime StatedTime::parse(std::string_view text, std::string_view what) {
  const auto unit_at = text.find_first_not_of("0123456789./-");
  const std::string_view name = unit_at == std::string_view::npos ? std::string_view() : text.substr(unit_at);
  const auto unit = std::find_if(kUnits.begin(), kUnits.end(),
                                 [&](const Unit& candidate) { return candidate.name == name; });
  if (text.find(',') == unit_at && unit_at != text.npos && text.find('.') == text.npos)
    throw UsageError(format("{} '{}' is no time; the decimal mark is a point: 0.4s", what, text));
  if (unit == kUnits.end() || unit_at == 0) {
    throw UsageError(
        format("{} '{}' is no time; write a number and a unit: 0.4s, 10ms, 250us, 1/100s, or "
               "37f for pictures of the clip",
               what, text));
  }
  const std::string_view number = text.substr(0, unit_at);
  // Of a long capture nanoseconds have more digits than numbers of other kinds may.
  std::int64_t whole = 0;
  const auto [end, error] = std::from_chars(number.begin(), number.end(), whole);
  const bool is_whole = error == std::errc() && end == number.end();
  StatedTime time{is_whole && unit->nanoseconds == 1 ? Rational{whole, 1} : Rational::parse(number, what),
                  unit->nanoseconds};
  if (!time.counts_samples() &&
      static_cast<double>(time.unit_ns) * std::abs(time.number.value()) > static_cast<double>(kLongestNs)) {
    throw UsageError(format("{} '{}' is longer than 126 years", what, text));
  }
  return time;
}

std::int64_t StatedTime::nanoseconds() const {
  return rounded(exact_nanoseconds());
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

std::int64_t moment_ns(const StatedTime& time, const Timeline& timeline) {
  if (!time.counts_samples()) return time.nanoseconds();
  return timeline.start_ns(existing_sample(whole_samples(time, "start"), timeline));
}

Exposure plain_interval(const StatedTime& start, const StatedTime& length, const Timeline& timeline) {
  if (!start.counts_samples()) return plain_interval(exact_time(start, "start", timeline), length, timeline);
  if (length.number.numerator <= 0) refuse_length(length, "not longer than nothing");
  const std::int64_t first = whole_samples(start, "start");
  const std::uint64_t sample = existing_sample(first, timeline);
  if (!length.counts_samples())
    return plain_interval(ExactTime::of_sample(timeline, sample), length, timeline);
  const std::int64_t last = first + whole_samples(length, "exposure") - 1;
  return checked({timeline.start_ns(sample), timeline.end_ns(existing_sample(last, timeline))}, length);
}

Exposure plain_interval(const ExactTime& start, const StatedTime& length, const Timeline& timeline) {
  if (length.number.numerator <= 0) refuse_length(length, "not longer than nothing");
  const std::int64_t start_ns = rounded(start);
  const ExactTime exact = length.counts_samples()
                              ? periods_from(start_ns, whole_samples(length, "exposure"), timeline)
                              : exact_time(length, "exposure", timeline);
  return checked({start_ns, rounded_sum(start, exact)}, length);
}

std::uint64_t sample_at(std::int64_t time_ns, const Timeline& timeline) {
  const std::int64_t inside_ns = std::clamp<std::int64_t>(time_ns, 0, timeline.duration_ns() - 1);
  return timeline.samples_reaching(inside_ns, inside_ns + 1).first;
}

std::uint64_t sample_at(const StatedTime& time, std::string_view what, const Timeline& timeline) {
  if (time.counts_samples()) return existing_sample(whole_samples(time, what), timeline);
  const std::int64_t time_ns = time.nanoseconds();
  if (time_ns < 0 || time_ns > timeline.duration_ns()) {
    throw UsageError(format("{} {} lies outside the capture, which lasts {}", what, time.text(),
                            duration_text(timeline.duration_ns())));
  }
  return sample_at(time_ns, timeline);
}

ExactTime exact_time(const StatedTime& time, std::string_view what, const Timeline& timeline) {
  if (!time.counts_samples()) return time.exact_nanoseconds();
  const std::int64_t sample = whole_samples(time, what);
  if (sample == static_cast<std::int64_t>(timeline.sample_count())) return {timeline.duration_ns(), 1};
  return ExactTime::of_sample(timeline, existing_sample(sample, timeline));
}

}  // namespace nutik
