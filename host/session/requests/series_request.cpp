#include "session/requests/series_request.hpp"

#include <algorithm>

#include "capture/format.hpp"
#include "session/text/time_text.hpp"

namespace nutik {
namespace {

StatedTime start_of(const StatedTime& every, const StatedTime& first, std::uint64_t k,
                    const Timeline& timeline) {
  const auto steps = static_cast<int128>(k);
  if (every.counts_samples()) {
    const auto pictures = static_cast<std::int64_t>(steps * every.number.numerator);
    if (first.counts_samples()) return StatedTime::of_pictures(first.number.numerator + pictures);
    // So many pictures after the one at the start.
    const std::int64_t first_ns = first.nanoseconds();
    const auto left = static_cast<std::int64_t>(timeline.sample_count() - sample_at(first_ns, timeline));
    return pictures == 0 ? first
                         : StatedTime::of(exact_time(first, "start", timeline) +
                                          periods_from(first_ns, std::min(pictures, left), timeline));
  }
  const ExactTime start = exact_time(first, "start", timeline);
  const ExactTime later{steps * every.number.numerator * every.unit_ns, every.number.denominator};
  return StatedTime::of(start + later);
}

bool starts_within(const StatedTime& start, const Timeline& timeline) {
  return start.counts_samples() ? start.number.numerator < static_cast<std::int64_t>(timeline.sample_count())
                                : start.nanoseconds() < timeline.duration_ns();
}

bool ends_within(const ExposureRequest& request, const StatedTime& start, const Timeline& timeline) {
  if (!starts_within(start, timeline)) return false;
  const auto* plain = std::get_if<PlainInterval>(&request.gains);
  if (plain == nullptr)
    return moment_ns(start, timeline) + functions_end_ns(request) <= timeline.duration_ns();
  if (!plain->length.counts_samples())
    return plain_interval(start, plain->length, timeline).end_ns <= timeline.duration_ns();
  // plain_interval() throws where pictures are counted that are not there.
  const std::uint64_t first = sample_at(moment_ns(start, timeline), timeline);
  return first + static_cast<std::uint64_t>(plain->length.number.numerator) <= timeline.sample_count();
}

}  // namespace

std::vector<StatedTime> starts_of(const SeriesRequest& series, const ExposureRequest& request,
                                  const Timeline& timeline) {
  if (const std::int64_t first_ns = moment_ns(request.start, timeline); first_ns >= timeline.duration_ns()) {
    throw UsageError(format("the series starts at {}, behind the end of the capture at {}",
                            duration_text(first_ns), duration_text(timeline.duration_ns())));
  }
  if (series.every.number.numerator <= 0)
    throw UsageError(format("exposures that are {} apart are no series", series.every.text()));
  std::vector<StatedTime> starts;
  for (std::uint64_t k = 0; !series.count || k < *series.count; ++k) {
    const StatedTime next = start_of(series.every, request.start, k, timeline);
    if (!series.count && !ends_within(request, next, timeline)) break;
    if (series.count && !starts_within(next, timeline)) {
      const bool counts = next.counts_samples();
      throw UsageError(
          format("exposure {} of the series would start at {}, behind the end of the capture{}", k,
                 counts ? next.text() : duration_text(next.nanoseconds()),
                 counts ? format(", which has {} pictures", timeline.sample_count())
                        : format(" at {}", duration_text(timeline.duration_ns()))),
          Advice{format("; `count {}` at most", k)});
    }
    if (k == SeriesRequest::kMaxExposures)
      throw UsageError(format("the series has more than {} exposures", SeriesRequest::kMaxExposures),
                       Advice{"; say how many with `count`"});
    starts.push_back(next);
  }
  if (starts.empty()) {
    throw UsageError(format("not one exposure of the series ends within the capture, which lasts {}",
                                  duration_text(timeline.duration_ns())),
                     Advice{"; `count 1` makes one that goes on behind its end"});
  }
  return starts;
}

}  // namespace nutik
