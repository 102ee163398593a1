#include "app/input/exposure_series.hpp"

#include <algorithm>

#include "app/text/number_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

// More files than a folder is pleasant with, and than anybody means.
constexpr std::uint32_t kMost = 1'000'000;

}  // namespace

ExposureSeries ExposureSeries::from(const Options& options) {
  ExposureSeries series;
  series.every_text_ = *options.every;
  series.every_ = TimeText::parse(*options.every, "every");
  if (series.every_.number.numerator <= 0) {
    throw UsageError(format("every '{}' is not longer than nothing", *options.every));
  }
  if (series.every_.counts_samples() && series.every_.number.denominator != 1) {
    throw UsageError(format("every '{}' is not a whole number of pictures", *options.every));
  }
  if (options.count) series.count_ = parse_whole_number(*options.count, "count", 1, kMost);
  return series;
}

TimeText ExposureSeries::start(const TimeText& first, std::uint64_t k, const Timeline& timeline) const {
  const auto steps = static_cast<int128>(k);
  if (every_.counts_samples()) {
    const auto pictures = static_cast<std::int64_t>(steps * every_.number.numerator);
    if (first.counts_samples()) return {{first.number.numerator + pictures, 1}, 0};
    // So many pictures after the one at the start.
    const std::int64_t first_ns = first.nanoseconds();
    const std::int64_t inside_ns = std::clamp<std::int64_t>(first_ns, 0, timeline.duration_ns() - 1);
    const std::uint64_t sample = timeline.samples_reaching(inside_ns, inside_ns + 1).first;
    const std::uint64_t later = sample + static_cast<std::uint64_t>(pictures);
    const std::int64_t later_ns =
        later < timeline.sample_count() ? timeline.start_ns(later) : timeline.duration_ns();
    return TimeText::of_nanoseconds(first_ns + later_ns - timeline.start_ns(sample));
  }
  const std::int64_t later_ns =
      round_half_up(steps * every_.number.numerator * every_.unit_ns, every_.number.denominator);
  return TimeText::of_nanoseconds(moment_ns(first, timeline) + later_ns);
}

bool ExposureSeries::starts_within(const TimeText& start, const Timeline& timeline) {
  if (start.counts_samples()) {
    return start.number.numerator < static_cast<std::int64_t>(timeline.sample_count());
  }
  return start.number.numerator < timeline.duration_ns();
}

bool ExposureSeries::ends_within(const ExposureRequest& request, const TimeText& start,
                                 const Timeline& timeline) {
  if (!starts_within(start, timeline)) return false;
  if (!request.is_plain())
    return moment_ns(start, timeline) + request.functions_end_ns() <= timeline.duration_ns();
  const TimeText& length = request.length();
  if (!length.counts_samples())
    return plain_interval(start, length, timeline).end_ns <= timeline.duration_ns();
  // plain_interval() throws where pictures are counted that are not there.
  const std::int64_t start_ns =
      std::clamp<std::int64_t>(moment_ns(start, timeline), 0, timeline.duration_ns() - 1);
  const std::uint64_t first = timeline.samples_reaching(start_ns, start_ns + 1).first;
  return first + static_cast<std::uint64_t>(length.number.numerator) <= timeline.sample_count();
}

std::vector<TimeText> ExposureSeries::starts(const ExposureRequest& request, const Timeline& timeline) const {
  const TimeText& first = request.start();
  if (const std::int64_t first_ns = moment_ns(first, timeline); first_ns >= timeline.duration_ns()) {
    throw UsageError(format("the series starts at {}, behind the end of the capture at {}",
                            duration_text(first_ns), duration_text(timeline.duration_ns())));
  }
  std::vector<TimeText> starts;
  for (std::uint64_t k = 0; !count_ || k < *count_; ++k) {
    const TimeText next = start(first, k, timeline);
    if (!count_ && !ends_within(request, next, timeline)) break;
    if (count_ && !starts_within(next, timeline)) {
      throw UsageError(format(
          "exposure {} of the series would start at {}, behind the end of the capture{}; --count {} at most",
          k, next.counts_samples() ? next.text() : duration_text(next.nanoseconds()),
          next.counts_samples() ? format(", which has {} pictures", timeline.sample_count())
                                : format(" at {}", duration_text(timeline.duration_ns())),
          k));
    }
    if (k == kMost)
      throw UsageError(format("the series has more than {} exposures; say how many with --count", kMost));
    starts.push_back(next);
  }
  if (starts.empty()) {
    throw UsageError(
        format("not one exposure of the series ends within the capture, which lasts {}; --count 1 makes one "
               "that goes on behind its end",
               duration_text(timeline.duration_ns())));
  }
  return starts;
}

}  // namespace nutik::app
