#include "app/text/time_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

struct Unit {
  std::string_view name;
  std::int64_t nanoseconds;
};

constexpr std::array<Unit, 8> kUnits{{{"s", 1'000'000'000},
                                      {"ms", 1'000'000},
                                      {"us", 1000},
                                      {"µs", 1000},
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

std::int64_t whole_samples(const TimeText& time, std::string_view what) {
  if (time.number.denominator != 1) {
    throw UsageError(format("{} {}f is not a whole number of pictures", what, time.number.text()));
  }
  return time.number.numerator;
}

// How long `count` periods from the picture at a time are.
std::int64_t periods_ns(std::int64_t time_ns, std::int64_t count, const Timeline& timeline) {
  const std::int64_t inside_ns = std::clamp<std::int64_t>(time_ns, 0, timeline.duration_ns() - 1);
  const std::uint64_t first = timeline.samples_reaching(inside_ns, inside_ns + 1).first;
  const std::uint64_t last = existing_sample(static_cast<std::int64_t>(first) + count - 1, timeline);
  const bool at_end = last + 1 == timeline.sample_count();
  return (at_end ? timeline.duration_ns() : timeline.start_ns(last + 1)) - timeline.start_ns(first);
}

}  // namespace

TimeText TimeText::parse(std::string_view text, std::string_view what) {
  const auto unit_at = text.find_first_not_of("0123456789./-");
  const std::string_view name = unit_at == std::string_view::npos ? std::string_view() : text.substr(unit_at);
  const auto unit = std::find_if(kUnits.begin(), kUnits.end(),
                                 [&](const Unit& candidate) { return candidate.name == name; });
  if (unit == kUnits.end() || unit_at == 0) {
    throw UsageError(
        format("{} '{}' is no time; write a number and a unit: 0.4s, 10ms, 250us, 1/100s, or "
               "37f for pictures of the clip",
               what, text));
  }
  TimeText time{Rational::parse(text.substr(0, unit_at), what), unit->nanoseconds};
  if (!time.counts_samples() &&
      static_cast<double>(time.unit_ns) * std::abs(time.number.value()) > static_cast<double>(kLongestNs)) {
    throw UsageError(format("{} '{}' is longer than 126 years", what, text));
  }
  return time;
}

std::int64_t TimeText::nanoseconds() const {
  return round_half_up(static_cast<int128>(number.numerator) * unit_ns, number.denominator);
}

std::string TimeText::text() const {
  if (counts_samples()) return format("{}f", number.text());
  // The coarsest unit that holds it in whole numbers.
  for (const Unit& unit : kUnits) {
    if (unit.nanoseconds == 0 || unit.nanoseconds > kUnits.front().nanoseconds) continue;
    const int128 nanoseconds = static_cast<int128>(number.numerator) * unit_ns;
    const int128 whole = static_cast<int128>(number.denominator) * unit.nanoseconds;
    if (nanoseconds % whole == 0)
      return format("{}{}", static_cast<std::int64_t>(nanoseconds / whole), unit.name);
  }
  return format("{}ns", Rational{number.numerator * unit_ns, number.denominator}.text());
}

std::int64_t moment_ns(const TimeText& time, const Timeline& timeline) {
  if (!time.counts_samples()) return time.nanoseconds();
  return timeline.start_ns(existing_sample(whole_samples(time, "start"), timeline));
}

Exposure plain_interval(const TimeText& from, const TimeText& length, const Timeline& timeline) {
  const auto fail = [&](std::string_view why) {
    throw UsageError(format("exposure '{}' is {}", length.text(), why));
  };
  if (length.number.numerator <= 0) fail("not longer than nothing");
  const std::int64_t count = length.counts_samples() ? whole_samples(length, "exposure") : 0;
  Exposure interval;
  interval.start_ns = moment_ns(from, timeline);
  if (count == 0) {
    interval.end_ns = interval.start_ns + length.nanoseconds();
  } else if (from.counts_samples()) {
    const std::int64_t first = whole_samples(from, "start");
    interval.end_ns = timeline.end_ns(existing_sample(first + count - 1, timeline));
  } else {
    interval.end_ns = interval.start_ns + periods_ns(interval.start_ns, count, timeline);
  }
  if (interval.end_ns <= interval.start_ns) fail("shorter than a nanosecond");
  // GainFunction could not hold later times.
  interval.end_ns = std::min(interval.end_ns, std::max(kLongestNs, interval.start_ns));
  return interval;
}

Exposure plain_interval(std::string_view start, std::string_view exposure, const Timeline& timeline) {
  return plain_interval(TimeText::parse(start, "start"), TimeText::parse(exposure, "exposure"), timeline);
}

std::uint64_t sample_at(std::string_view text, std::string_view what, const Timeline& timeline) {
  const TimeText time = TimeText::parse(text, what);
  if (time.counts_samples()) return existing_sample(whole_samples(time, what), timeline);
  const std::int64_t time_ns = time.nanoseconds();
  if (time_ns < 0 || time_ns > timeline.duration_ns()) {
    throw UsageError(format("{} {} lies outside the capture, which lasts {}", what, text,
                            duration_text(timeline.duration_ns())));
  }
  const std::int64_t inside_ns = std::min(time_ns, timeline.duration_ns() - 1);
  return timeline.samples_reaching(inside_ns, inside_ns + 1).first;
}

ExactTime exact_time(std::string_view text, std::string_view what, const Timeline& timeline) {
  const TimeText time = TimeText::parse(text, what);
  if (!time.counts_samples()) {
    return {static_cast<int128>(time.number.numerator) * time.unit_ns, time.number.denominator};
  }
  const std::int64_t sample = whole_samples(time, what);
  if (sample == static_cast<std::int64_t>(timeline.sample_count())) return {timeline.duration_ns(), 1};
  return ExactTime::of_sample(timeline, existing_sample(sample, timeline));
}

std::string duration_text(std::int64_t nanoseconds) {
  const auto value = static_cast<double>(nanoseconds);
  if (nanoseconds < 1000) return format("{} ns", nanoseconds);
  if (nanoseconds < 1'000'000) return format("{:.4g} us", value * 1e-3);
  if (nanoseconds < 1'000'000'000) return format("{:.4g} ms", value * 1e-6);
  return format("{:.4g} s", value * 1e-9);
}

std::string integral_text(double nanoseconds) {
  if (nanoseconds == 0.0) return "0 s";
  const double length = std::fabs(nanoseconds);
  // What would be rounded up to the next unit is shown in it.
  if (length >= 999'999'500.0) return format("{:.6g} s", nanoseconds * 1e-9);
  if (length >= 999'999.5) return format("{:.6g} ms", nanoseconds * 1e-6);
  if (length >= 999.9995) return format("{:.6g} us", nanoseconds * 1e-3);
  return format("{:.6g} ns", nanoseconds);
}

}  // namespace nutik::app
