// The integral of light times gain over one straight stretch of a pixel's light, edge by edge.
// Used by the reference alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "exposure/compensated_sum.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

// Light that runs straight from `begin` to `end`.
struct LightStretch {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] double at(std::int64_t time_ns) const {
    if (begin == end) return begin;
    return begin + (end - begin) * (static_cast<double>(time_ns - begin_ns) /
                                    static_cast<double>(end_ns - begin_ns));
  }
};

// A gain function as the reference reads it: straight from its control points.
class GainWalk {
 public:
  // Gains are divided by 2^exponent() so that the sums neither overflow nor lose digits; the caller
  // multiplies the result by it.
  GainWalk(std::span<const ControlPoint> points, std::int64_t duration_ns) : points_(points) {
    double largest = 0.0;
    for (std::size_t next = 0; next <= points.size(); ++next) {
      const std::int64_t begin = std::max<std::int64_t>(next == 0 ? 0 : points[next - 1].time_ns, 0);
      const std::int64_t end = std::min(next == points.size() ? duration_ns : points[next].time_ns,
                                        duration_ns);
      const double before = next == 0 ? points[0].gain : points[next - 1].gain;
      const double after = next == points.size() ? before : points[next].gain;
      if (begin >= end || (before == 0.0 && after == 0.0)) continue;
      support_ns_ += end - begin;
      largest = std::max({largest, std::fabs(before), std::fabs(after)});
    }
    exponent_ = largest > 0.0 ? std::ilogb(largest) : 0;
  }

  [[nodiscard]] int exponent() const { return exponent_; }
  [[nodiscard]] std::int64_t support_ns() const { return support_ns_; }  // D

  // Calls visit(begin_ns, end_ns, gain at begin, gain at end) for every interval of [begin_ns, end_ns]
  // between two control points. `next` is the walk's place: the first control point after begin_ns or
  // one before that.
  template <typename Visit>
  void for_each_interval(std::int64_t begin_ns, std::int64_t end_ns, std::size_t& next,
                         Visit visit) const {
    std::int64_t time_ns = begin_ns;
    while (time_ns < end_ns) {
      while (next < points_.size() && points_[next].time_ns <= time_ns) ++next;
      const std::int64_t until_ns =
          next < points_.size() ? std::min(points_[next].time_ns, end_ns) : end_ns;
      visit(time_ns, until_ns, gain_at(next, time_ns), gain_at(next, until_ns));
      time_ns = until_ns;
    }
  }

 private:
  // The scaled gain at a time between control points next - 1 and next.
  [[nodiscard]] double gain_at(std::size_t next, std::int64_t time_ns) const {
    if (next == 0) return std::scalbn(points_.front().gain, -exponent_);
    const ControlPoint& left = points_[next - 1];
    const double from = std::scalbn(left.gain, -exponent_);
    if (next == points_.size()) return from;
    const ControlPoint& right = points_[next];
    const double to = std::scalbn(right.gain, -exponent_);
    if (time_ns == right.time_ns) return to;
    return from + (to - from) * (static_cast<double>(time_ns - left.time_ns) /
                                 static_cast<double>(right.time_ns - left.time_ns));
  }

  std::span<const ControlPoint> points_;
  int exponent_ = 0;
  std::int64_t support_ns_ = 0;
};

// ∫ light × gain over the interval, both straight on it: mean times mean, plus a twelfth of the product
// of their rises, times the length.
inline double integrate_interval(double length_ns, double light0, double light1, double gain0,
                                 double gain1) {
  const double means = (light0 + light1) * (gain0 + gain1) / 4.0;
  const double rises = (light1 - light0) * (gain1 - gain0) / 12.0;
  return length_ns * (means + rises);
}

}  // namespace nutik
