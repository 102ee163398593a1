#include "features/series/series_request.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "capture/format.hpp"
#include "capture/text.hpp"
#include "session/text/number_text.hpp"

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

bool starts_within(const StatedTime& start, const ExposureRequest& request, const Timeline& timeline) {
  if (start.counts_samples()) return start.number.numerator < static_cast<std::int64_t>(timeline.sample_count());
  return start.nanoseconds() < int128{timeline.duration_ns()} - delay_ends_ns(request.delay).first;
}

bool ends_within(const ExposureRequest& request, const StatedTime& start, const Timeline& timeline) {
  if (!starts_within(start, request, timeline)) return false;
  const int128 end_ns = int128{timeline.duration_ns()} - delay_ends_ns(request.delay).second;
  const auto* plain = std::get_if<PlainInterval>(&request.gains);
  // Functions end with the capture: their last step down may lie 1 ns behind it.
  if (plain == nullptr)
    return moment_ns(start, timeline) + functions_end_ns(request) <= end_ns + 1;
  // plain_interval() throws where pictures are counted that are not there.
  if (plain->length.counts_samples()) {
    const std::uint64_t first = sample_at(moment_ns(start, timeline), timeline);
    if (first + static_cast<std::uint64_t>(plain->length.number.numerator) > timeline.sample_count()) return false;
  }
  return plain_interval(start, plain->length, timeline).end_ns <= end_ns;
}

}  // namespace

std::vector<StatedTime> starts_of(const SeriesRequest& series, const ExposureRequest& request,
                                  const Timeline& of_capture) {
  const Timeline& timeline = of_capture.pictures();
  const std::string_view delayed = request.delay ? "with all its delays " : "";
  if (!starts_within(request.start, request, timeline)) {
    throw UsageError(format("the series starts at {}, {}behind the end of the capture at {}",
                            duration_text(moment_ns(request.start, timeline)), delayed,
                            duration_text(timeline.duration_ns())));
  }
  if (series.every.number.numerator <= 0)
    throw UsageError(format("exposures that are {} apart are no series", series.every.text()));
  std::vector<StatedTime> starts;
  for (std::uint64_t k = 0; !series.count || k < *series.count; ++k) {
    const StatedTime next = start_of(series.every, request.start, k, timeline);
    if (!series.count && !ends_within(request, next, timeline)) break;
    if (series.count && !starts_within(next, request, timeline)) {
      const bool counts = next.counts_samples();
      throw UsageError(
          format("exposure {} of the series would start at {}, {}behind the end of the capture{}", k,
                 counts ? next.text() : duration_text(next.nanoseconds()), counts ? "" : delayed,
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

namespace {

// A number at the start of a text, which loses it.
std::optional<std::uint64_t> take_frame(std::string_view& text) {
  constexpr std::uint64_t kMost = 999'999'999'999;
  std::uint64_t frame = 0;
  return take_number(text, frame) && frame <= kMost ? std::optional(frame) : std::nullopt;
}

}  // namespace

FrameRanges FrameRanges::parse(std::string_view text, std::string_view what) {
  const auto fail = [&](std::string_view part) {
    throw UsageError(format("{} '{}': '{}' is no range of frames; write numbers from 0 on: 7, 1-100, 1-100x2 for "
                            "every second, several with commas between",
                            what, text, part));
  };
  FrameRanges ranges;
  ranges.text_ = text;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(", ", begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    begin = end + 1;
    if (part.empty()) continue;
    std::string_view rest = part;
    const auto first = take_frame(rest);
    if (!first) fail(part);
    Range range{*first, *first, *first, 1, false};
    if (rest.starts_with('-')) {
      rest.remove_prefix(1);
      const auto last = take_frame(rest);
      if (!last) fail(part);
      range.least = std::min(*first, *last);
      range.most = std::max(*first, *last);
      if (!rest.empty()) {
        const char kind = rest.front();
        rest.remove_prefix(1);
        const auto step = take_frame(rest);
        if (!step || *step == 0 || (kind != 'x' && kind != 'y' && kind != ':')) fail(part);
        if (kind != ':') range.step = *step;
        range.leaves_out = kind == 'y';
      }
    }
    if (!rest.empty()) fail(part);
    ranges.ranges_.push_back(range);
  }
  if (ranges.ranges_.empty()) fail(text);
  return ranges;
}

std::vector<std::uint64_t> FrameRanges::below(std::uint64_t count) const {
  std::vector<std::uint64_t> numbers;
  for (const Range& range : ranges_) {
    for (std::uint64_t k = range.least; k <= range.most && k < count; ++k) {
      const std::uint64_t apart = k < range.from ? range.from - k : k - range.from;
      if ((apart % range.step == 0) != range.leaves_out) numbers.push_back(k);
    }
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<std::uint64_t> chosen_numbers(const std::optional<FrameRanges>& ranges, std::uint64_t count,
                                          std::string_view what, std::string_view whole) {
  if (!ranges) {
    std::vector<std::uint64_t> all(count);
    std::iota(all.begin(), all.end(), std::uint64_t{0});
    return all;
  }
  std::vector<std::uint64_t> numbers = ranges->below(count);
  if (!numbers.empty()) return numbers;
  throw UsageError(format("none of the {} {} is there: the {} has {}, numbered from 0 to {}", what, ranges->text(),
                          whole, count, count - 1));
}

std::string ranges_text(std::span<const std::uint64_t> numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += format("{}{}", text.empty() ? "" : ", ", numbers[i]);
    if (last > i) text += format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace nutik
