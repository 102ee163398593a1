#include "session/requests/stated_moments.hpp"

#include <algorithm>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

// The number of a picture that was filmed.
std::uint64_t existing_picture(std::int64_t picture, const Timeline& pictures) {
  const auto count = static_cast<std::int64_t>(pictures.sample_count());
  if (picture < 0 || picture >= count) {
    throw UsageError(
        format("picture {} is outside the capture, which has {} (0f … {}f)", picture, count, count - 1));
  }
  return static_cast<std::uint64_t>(picture);
}

std::int64_t whole_pictures(const StatedTime& time, std::string_view what) {
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
  interval.end_ns = std::min(interval.end_ns, std::max(kLargestTimeNs, interval.start_ns));
  return interval;
}

// The start of a sample that may lie outside the capture.
std::int64_t start_anywhere(std::int64_t sample, const Timeline& timeline) {
  const auto count = static_cast<std::int64_t>(timeline.sample_count());
  const std::int64_t period_ns = std::max<std::int64_t>(timeline.duration_ns() / count, 1);
  // No further than times go.
  const std::int64_t most = kLargestTimeNs / period_ns;
  if (sample < 0) return std::max(sample, -most) * period_ns;
  if (sample < count) return timeline.start_ns(static_cast<std::uint64_t>(sample));
  const std::int64_t beyond = std::min(sample - count, most) * period_ns;
  return std::min(timeline.duration_ns(), kLargestTimeNs - beyond) + beyond;
}

}  // namespace

ExactTime periods_from(std::int64_t time_ns, std::int64_t count, const Timeline& timeline) {
  const Timeline& pictures = timeline.pictures();
  const std::uint64_t first = sample_at(time_ns, pictures);
  const std::uint64_t last = existing_picture(static_cast<std::int64_t>(first) + count - 1, pictures);
  if (pictures.is_constant()) return ExactTime::of_sample(pictures, static_cast<std::uint64_t>(count));
  const bool at_end = last + 1 == pictures.sample_count();
  return {(at_end ? pictures.duration_ns() : pictures.start_ns(last + 1)) - pictures.start_ns(first), 1};
}

std::int64_t moment_ns(const StatedTime& time, const Timeline& timeline) {
  if (!time.counts_samples()) return time.nanoseconds();
  const Timeline& pictures = timeline.pictures();
  return pictures.start_ns(existing_picture(whole_pictures(time, "start"), pictures));
}

Exposure plain_interval(const StatedTime& start, const StatedTime& length, const Timeline& timeline) {
  if (!start.counts_samples()) return plain_interval(exact_time(start, "start", timeline), length, timeline);
  if (length.number.numerator <= 0) refuse_length(length, "not longer than nothing");
  const Timeline& pictures = timeline.pictures();
  const std::int64_t first = whole_pictures(start, "start");
  const std::uint64_t picture = existing_picture(first, pictures);
  if (!length.counts_samples())
    return plain_interval(ExactTime::of_sample(pictures, picture), length, pictures);
  const std::int64_t last = first + whole_pictures(length, "exposure") - 1;
  return checked({pictures.start_ns(picture), pictures.end_ns(existing_picture(last, pictures))}, length);
}

Exposure plain_interval(const ExactTime& start, const StatedTime& length, const Timeline& timeline) {
  if (length.number.numerator <= 0) refuse_length(length, "not longer than nothing");
  const std::int64_t start_ns = rounded(start);
  const ExactTime exact = length.counts_samples()
                              ? periods_from(start_ns, whole_pictures(length, "exposure"), timeline)
                              : exact_time(length, "exposure", timeline);
  return checked({start_ns, rounded_sum(start, exact)}, length);
}

std::uint64_t sample_at(std::int64_t time_ns, const Timeline& timeline) {
  const std::int64_t inside_ns = std::clamp<std::int64_t>(time_ns, 0, timeline.duration_ns() - 1);
  return timeline.samples_reaching(inside_ns, inside_ns + 1).first;
}

std::uint64_t sample_at(const StatedTime& time, std::string_view what, const Timeline& timeline) {
  if (time.counts_samples())
    return timeline.sample_of(existing_picture(whole_pictures(time, what), timeline.pictures()));
  const std::int64_t time_ns = time.nanoseconds();
  if (time_ns < 0 || time_ns > timeline.duration_ns()) {
    throw UsageError(format("{} {} lies outside the capture, which lasts {}", what, time.text(),
                            duration_text(timeline.duration_ns())));
  }
  return sample_at(time_ns, timeline);
}

ExactTime exact_time(const StatedTime& time, std::string_view what, const Timeline& timeline) {
  if (!time.counts_samples()) return time.exact_nanoseconds();
  const Timeline& pictures = timeline.pictures();
  const std::int64_t picture = whole_pictures(time, what);
  if (picture == static_cast<std::int64_t>(pictures.sample_count())) return {pictures.duration_ns(), 1};
  return ExactTime::of_sample(pictures, existing_picture(picture, pictures));
}

StatedTime stated_sample(std::uint64_t sample, const Timeline& timeline) {
  const auto picture = timeline.picture_of(sample);
  return picture ? StatedTime::of_pictures(static_cast<std::int64_t>(*picture))
                 : StatedTime::of_nanoseconds(timeline.start_ns(sample));
}

std::int64_t samples_later(std::int64_t time_ns, std::int64_t steps, const Timeline& timeline) {
  const auto sample = static_cast<std::int64_t>(sample_at(time_ns, timeline));
  // Behind the end the first sample beyond it is stepped from, so that steps there and back agree.
  const auto count = static_cast<std::int64_t>(timeline.sample_count());
  std::int64_t from = sample;
  if (time_ns >= timeline.duration_ns()) {
    const std::int64_t period_ns = std::max<std::int64_t>(timeline.duration_ns() / count, 1);
    from = count + (time_ns - timeline.duration_ns()) / period_ns;
  } else if (time_ns < 0) {
    const std::int64_t period_ns = std::max<std::int64_t>(timeline.duration_ns() / count, 1);
    from = -1 - (-1 - time_ns) / period_ns;
  }
  const std::int64_t later = start_anywhere(from + steps, timeline) + (time_ns - start_anywhere(from, timeline));
  return std::clamp(later, -kLargestTimeNs, kLargestTimeNs);
}

}  // namespace nutik
