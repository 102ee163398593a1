#include "exposure/key_frame_values.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exposure/function_text.hpp"

namespace nutik {
namespace {

double gain_at(const GainFunction& function, std::int64_t time_ns) {
  const auto points = function.points();
  const auto next = std::ranges::upper_bound(points, time_ns, {}, &ControlPoint::time_ns);
  if (next == points.begin()) return function.first_gain();
  const auto before = next - 1;
  if (next == points.end() || before->time_ns == time_ns) return before->gain;
  return GainPiece{before->time_ns, next->time_ns, before->gain, next->gain}.at(time_ns);
}

std::vector<std::int64_t> times_of_both(const GainFunction& a, const GainFunction& b) {
  std::vector<std::int64_t> times;
  for (const ControlPoint& point : a.points()) times.push_back(point.time_ns);
  for (const ControlPoint& point : b.points()) times.push_back(point.time_ns);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

std::int64_t time_between(std::int64_t a_ns, std::int64_t b_ns, const KeyShare& share) {
  const int128 way = static_cast<int128>(b_ns) - a_ns;  // times `passed` below 2^126
  return a_ns + static_cast<std::int64_t>(round_half_up(way * share.passed, share.whole));
}

GainFunction function_between(const GainFunction& a, const GainFunction& b, const KeyShare& share) {
  if (share.passed == 0) return a;
  if (share.passed == share.whole) return b;
  const GainFunction from = with_steps(a), to = with_steps(b);
  std::vector<ControlPoint> points;
  if (from.points().size() == to.points().size()) {
    // Points of either are 1 ns apart at least, and so are those between them, rounded or not.
    for (std::size_t i = 0; i < from.points().size(); ++i) {
      const ControlPoint &first = from.points()[i], &last = to.points()[i];
      points.push_back({time_between(first.time_ns, last.time_ns, share),
                        std::lerp(first.gain, last.gain, share.value())});
    }
  } else {
    for (const std::int64_t time_ns : times_of_both(from, to)) {
      points.push_back({time_ns, std::lerp(gain_at(from, time_ns), gain_at(to, time_ns), share.value())});
    }
  }
  return GainFunction(std::move(points));
}

}  // namespace nutik
