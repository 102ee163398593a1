#include "exposure/whole_course.hpp"

#include <algorithm>

namespace nutik {

Interval whole_course(const GainFunction& function, std::int64_t duration_ns) {
  return {std::min<std::int64_t>(0, function.points().front().time_ns),
          std::max(duration_ns, function.points().back().time_ns)};
}

GainSummary summarize_course(const GainFunction& function, std::int64_t duration_ns) {
  const Interval course = whole_course(function, duration_ns);
  GainSummary summary = summarize(function.shifted(-course.begin_ns), course.end_ns - course.begin_ns);
  if (!summary.live.empty()) {
    summary.live = {summary.live.begin_ns + course.begin_ns, summary.live.end_ns + course.begin_ns};
  }
  return summary;
}

}  // namespace nutik
