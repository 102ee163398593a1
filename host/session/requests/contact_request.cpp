#include "session/requests/contact_request.hpp"

#include <algorithm>
#include <cmath>

#include "capture/format.hpp"
#include "sheet/contact_sheet.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kDefaultCount = 24;

void check_count(int128 count, const StatedTime& every, std::int64_t span_ns) {
  if (count <= static_cast<int128>(sheet::kMaxPictures)) return;
  constexpr auto kMax = static_cast<std::int64_t>(sheet::kMaxPictures);
  std::int64_t min_ns = std::max<std::int64_t>((span_ns - 1) / kMax + 1, 1);
  std::int64_t unit_ns = 1;
  while (min_ns / unit_ns >= 1000) unit_ns *= 10;
  min_ns = (min_ns + unit_ns - 1) / unit_ns * unit_ns;
  const std::string least = StatedTime::of_nanoseconds(min_ns).text();
  throw UsageError(Advice{
      format("`every {}` makes {} pictures and a sheet holds {}; take `every {}` or more, or begin later with `start`", every.text(),
             static_cast<std::uint64_t>(std::min<int128>(count, INT64_MAX)), sheet::kMaxPictures, least)});
}

std::vector<ExactTime> starts_of(const ContactRequest& request, const Timeline& timeline) {
  const std::uint64_t first = sample_at(request.start, "start", timeline);
  std::vector<ExactTime> starts;
  if (!request.every || request.every->counts_samples()) {
    const std::uint64_t samples = timeline.sample_count() - first;
    const std::uint64_t stride = request.every ? static_cast<std::uint64_t>(request.every->number.numerator)
                                               : (samples + kDefaultCount - 1) / kDefaultCount;
    if (request.every) {
      check_count((samples + stride - 1) / stride, *request.every,
                  timeline.duration_ns() - timeline.start_ns(first));
    }
    for (std::uint64_t k = first; k < timeline.sample_count(); k += stride)
      starts.push_back(ExactTime::of_sample(timeline, k));
    return starts;
  }
  const StatedTime& every = *request.every;
  const std::int64_t start_ns = moment_ns(request.start, timeline);
  const std::int64_t span_ns = timeline.duration_ns() - start_ns;
  const int128 step = static_cast<int128>(every.number.numerator) * every.unit_ns;
  const int128 count = (static_cast<int128>(span_ns) * every.number.denominator + step - 1) / step;
  check_count(count, every, span_ns);
  const ExactTime start = exact_time(request.start, "start", timeline);
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(count); ++i) {
    const ExactTime at = start + ExactTime{i * step, every.number.denominator};
    if (round_half_up(at.numerator, at.denominator) < timeline.duration_ns()) starts.push_back(at);
  }
  return starts;
}

// As plain_interval has it; pictures that the capture no longer has may be counted, too. How far an exposure passes
// the end is all the same, as long as it does: a warning then says so.
Exposure interval_from(const ExactTime& start, const StatedTime& length, const Timeline& timeline) {
  const std::int64_t start_ns = round_half_up(start.numerator, start.denominator);
  if (length.counts_samples() && length.number.denominator == 1) {
    const std::uint64_t left = timeline.sample_count() - sample_at(start_ns, timeline);
    if (length.number.numerator > static_cast<std::int64_t>(left))
      return {start_ns, timeline.duration_ns() + 1};
  }
  return plain_interval(start, length, timeline);
}

}  // namespace

std::vector<Exposure> exposures_of(const ContactRequest& request, const Timeline& timeline) {
  std::vector<Exposure> exposures;
  for (const ExactTime& start : starts_of(request, timeline)) {
    if (request.length) {
      exposures.push_back(interval_from(start, *request.length, timeline));
    } else {
      const std::uint64_t sample = sample_at(round_half_up(start.numerator, start.denominator), timeline);
      exposures.push_back({timeline.start_ns(sample), timeline.end_ns(sample)});
    }
  }
  return exposures;
}

std::vector<std::string> labels_of(const std::vector<Exposure>& exposures, const Timeline& timeline) {
  struct Unit {
    const char* name;
    double nanoseconds;
  };
  const auto last = static_cast<double>(exposures.back().start_ns);
  constexpr double kHour = 3600e9;
  const Unit unit = last >= 1000 * kHour ? Unit{"days", 24 * kHour}
                    : last >= 10 * kHour ? Unit{"h", kHour}
                    : last >= 1e9        ? Unit{"s", 1e9}
                    : last >= 1e6        ? Unit{"ms", 1e6}
                    : last >= 1e3        ? Unit{"µs", 1e3}
                                         : Unit{"ns", 1};
  const double step = exposures.size() < 2
                          ? unit.nanoseconds
                          : static_cast<double>(exposures[1].start_ns - exposures[0].start_ns);
  const int decimals =
      static_cast<int>(std::clamp(1.0 - std::floor(std::log10(std::max(step, 1.0) / unit.nanoseconds)), 0.0,
                                  std::log10(unit.nanoseconds)));
  std::vector<std::string> labels;
  labels.reserve(exposures.size());
  for (const Exposure& exposure : exposures) {
    labels.push_back(format("{:.{}f} {}   {}f", static_cast<double>(exposure.start_ns) / unit.nanoseconds,
                            decimals, unit.name, sample_at(exposure.start_ns, timeline)));
  }
  return labels;
}

}  // namespace nutik
