#include "app/text/time_text.hpp"

#include <algorithm>
#include <array>

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

Exposure plain_interval(std::string_view start, std::string_view exposure, const Timeline& timeline) {
  const TimeText from = TimeText::parse(start, "start");
  const TimeText length = TimeText::parse(exposure, "exposure");
  if (length.number.numerator <= 0) {
    throw UsageError(format("exposure '{}' is not longer than nothing", exposure));
  }
  const std::int64_t count = length.counts_samples() ? whole_samples(length, "exposure") : 0;
  Exposure interval;
  if (from.counts_samples()) {
    const std::int64_t first = whole_samples(from, "start");
    interval.start_ns = timeline.start_ns(existing_sample(first, timeline));
    interval.end_ns = count > 0 ? timeline.end_ns(existing_sample(first + count - 1, timeline))
                                : interval.start_ns + length.nanoseconds();
  } else {
    interval.start_ns = from.nanoseconds();
    interval.end_ns = interval.start_ns +
                      (count > 0 ? periods_ns(interval.start_ns, count, timeline) : length.nanoseconds());
  }
  // Nothing behind the capture's end is exposed; GainFunction could not even hold some of these times.
  interval.end_ns = std::min(interval.end_ns, std::max(timeline.duration_ns() + 1, interval.start_ns + 1));
  if (interval.end_ns <= interval.start_ns) {
    throw UsageError(format("exposure '{}' is shorter than a nanosecond", exposure));
  }
  return interval;
}

std::string duration_text(std::int64_t nanoseconds) {
  const auto value = static_cast<double>(nanoseconds);
  if (nanoseconds < 1000) return format("{} ns", nanoseconds);
  if (nanoseconds < 1'000'000) return format("{:.4g} us", value * 1e-3);
  if (nanoseconds < 1'000'000'000) return format("{:.4g} ms", value * 1e-6);
  return format("{:.4g} s", value * 1e-9);
}

}  // namespace nutik::app
