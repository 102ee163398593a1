#include "studio/time/sample_times.hpp"

#include <algorithm>
#include <array>

#include "exposure/gain_function.hpp"
#include "session/requests/stated_time.hpp"

namespace nutik::studio {
namespace {

// The start of a sample that may lie outside the capture.
std::int64_t start_of(std::int64_t sample, const Timeline& timeline) {
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

std::int64_t nearest_sample_edge(std::int64_t time_ns, const Timeline& timeline) {
  const std::uint64_t sample = sample_at(time_ns, timeline);
  const SampleTimes times = timeline.times(sample);
  const std::array<std::int64_t, 4> edges{times.before_ns, times.start_ns, times.end_ns, times.after_ns};
  return *std::min_element(edges.begin(), edges.end(), [&](std::int64_t a, std::int64_t b) {
    return std::abs(a - time_ns) < std::abs(b - time_ns);
  });
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
  const std::int64_t later = start_of(from + steps, timeline) + (time_ns - start_of(from, timeline));
  return std::clamp(later, -kLargestTimeNs, kLargestTimeNs);
}

}  // namespace nutik::studio
