#include "studio/curves/points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nutik::studio {
namespace {

double finite(double gain) {
  constexpr double kMax = std::numeric_limits<double>::max();
  return std::clamp(gain, -kMax, kMax);
}

bool is_step(const Points& points, std::size_t first) {
  return first + 1 < points.size() && points[first + 1].time_ns - points[first].time_ns == 1;
}

std::vector<char> flags_of(const Points& points, const PointIndices& chosen) {
  std::vector<char> flags(points.size());
  for (const std::size_t index : chosen) flags[index] = 1;
  return flags;
}

bool has_increasing_times(const Points& points) {
  const auto falls = [](const ControlPoint& a, const ControlPoint& b) { return a.time_ns >= b.time_ns; };
  return std::adjacent_find(points.begin(), points.end(), falls) == points.end() &&
         points.front().time_ns >= -kLargestTimeNs && points.back().time_ns <= kLargestTimeNs;
}

std::int64_t scaled_time(std::int64_t time_ns, double factor, std::int64_t fixed_ns) {
  constexpr auto kMax = static_cast<double>(kLargestTimeNs);
  const double distance = static_cast<double>(time_ns - fixed_ns) * factor;
  return fixed_ns + static_cast<std::int64_t>(std::llround(std::clamp(distance, -kMax, kMax)));
}

}  // namespace

double gain_at(std::span<const ControlPoint> points, std::int64_t time_ns) {
  const auto after =
      std::upper_bound(points.begin(), points.end(), time_ns,
                       [](std::int64_t time, const ControlPoint& point) { return time < point.time_ns; });
  if (after == points.begin()) return points.front().gain;
  if (after == points.end()) return points.back().gain;
  const ControlPoint& before = *(after - 1);
  return GainPiece{before.time_ns, after->time_ns, before.gain, after->gain}.at(time_ns);
}

PointIndices with_whole_steps(const Points& points, const PointIndices& chosen) {
  std::vector<char> flags = flags_of(points, chosen);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (flags[i] && is_step(points, i)) flags[i + 1] = 1;
  for (std::size_t i = points.size() - 1; i > 0; --i)
    if (flags[i] && is_step(points, i - 1)) flags[i - 1] = 1;
  PointIndices whole;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (flags[i]) whole.push_back(i);
  return whole;
}

std::size_t step_anchor(const Points& points, std::size_t point) {
  std::size_t first = point, last = point;
  while (first > 0 && is_step(points, first - 1)) --first;
  while (is_step(points, last)) ++last;
  std::size_t anchor = point;
  for (std::size_t i = first; i <= last; ++i)
    if (std::fabs(points[i].gain) > std::fabs(points[anchor].gain)) anchor = i;
  return anchor;
}

Points moved(const Points& points, const PointIndices& chosen, PointShift by, Steps steps) {
  const PointIndices in_time = steps == Steps::kept ? with_whole_steps(points, chosen) : chosen;
  const std::vector<char> flags = flags_of(points, in_time);
  std::int64_t least = -kLargestTimeNs, most = kLargestTimeNs;
  for (const std::size_t i : in_time) {
    const std::int64_t time = points[i].time_ns;
    const std::int64_t before = i == 0 ? -kLargestTimeNs : points[i - 1].time_ns + 1;
    const std::int64_t behind = i + 1 == points.size() ? kLargestTimeNs : points[i + 1].time_ns - 1;
    if (i == 0 || !flags[i - 1]) least = std::max(least, before - time);
    if (i + 1 == points.size() || !flags[i + 1]) most = std::min(most, behind - time);
  }
  Points result = points;
  for (const std::size_t i : in_time) result[i].time_ns += std::clamp(by.time_ns, least, most);
  for (const std::size_t i : chosen) result[i].gain = finite(result[i].gain + by.gain);
  return result;
}

Points spread(const Points& points, const PointIndices& chosen, double factor, std::int64_t fixed_ns) {
  const PointIndices whole = with_whole_steps(points, chosen);
  const auto at = [&](double by) {
    Points result = points;
    for (const std::size_t i : whole) {
      const std::int64_t anchor = points[step_anchor(points, i)].time_ns;
      result[i].time_ns = scaled_time(anchor, by, fixed_ns) + points[i].time_ns - anchor;
    }
    return result;
  };
  Points wished = at(factor);
  if (has_increasing_times(wished)) return wished;
  // Times run straight from where they are to where they were wished, so that there is one place at which room ends.
  double roomy = 1.0, tight = factor;
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = roomy + (tight - roomy) / 2;
    (has_increasing_times(at(middle)) ? roomy : tight) = middle;
  }
  return at(roomy);
}

Points amplified(const Points& points, const PointIndices& chosen, double factor) {
  Points result = points;
  for (const std::size_t i : chosen) result[i].gain = finite(result[i].gain * factor);
  return result;
}

std::optional<AddedPoint> with_point(const Points& points, ControlPoint added) {
  const auto at =
      std::lower_bound(points.begin(), points.end(), added.time_ns,
                       [](const ControlPoint& point, std::int64_t time) { return point.time_ns < time; });
  if (at != points.end() && at->time_ns == added.time_ns) return std::nullopt;
  AddedPoint result{points, static_cast<std::size_t>(at - points.begin())};
  result.points.insert(result.points.begin() + (at - points.begin()), added);
  return result;
}

std::optional<Points> without(const Points& points, const PointIndices& chosen) {
  if (chosen.size() >= points.size()) return std::nullopt;
  const std::vector<char> flags = flags_of(points, chosen);
  Points result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!flags[i]) result.push_back(points[i]);
  return result;
}

std::optional<Points> with_point_set(const Points& points, std::size_t index, ControlPoint to) {
  Points result = points;
  result[index] = to;
  if (!has_increasing_times(result)) return std::nullopt;
  return result;
}

}  // namespace nutik::studio
