#include "studio/curves/gain_axis.hpp"

#include <algorithm>
#include <cmath>

namespace nutik::studio {
namespace {

constexpr double kRoom = 0.12;       // of what is shown, above and below
constexpr double kSmallest = 1e-12;  // gains that can be told apart in pictures are far larger
constexpr double kLargest = 1e15;

}  // namespace

GainRange range_with_room(std::span<const ControlPoint> points) {
  double low = 0.0, high = 0.0;
  for (const ControlPoint& point : points) {
    low = std::min(low, point.gain);
    high = std::max(high, point.gain);
  }
  // A gain of 1, which plain exposures have, is shown unless all gains are far from it.
  constexpr double kNear = 0.2;
  if (high > kNear || low == high) high = std::max(high, 1.0);
  low = std::max(low, -kLargest);
  high = std::min(high, kLargest);
  const double length = std::max(high - low, kSmallest);
  return {low - kRoom * length, high + kRoom * length};
}

void GainAxis::follow(std::span<const ControlPoint> points) {
  if (is_automatic_) range_ = range_with_room(points);
}

void GainAxis::zoom(double factor, double fixed) {
  const GainRange next{fixed + (range_.low - fixed) * factor, fixed + (range_.high - fixed) * factor};
  const double length = next.high - next.low;
  // So near to a large gain that doubles no longer tell the ends apart, nothing could be drawn.
  const double finest = std::max(kSmallest, 1e-9 * std::max(std::fabs(next.low), std::fabs(next.high)));
  if (!(length > finest) || length > kLargest) return;
  range_ = next;
  is_automatic_ = false;
}

void GainAxis::make_automatic(std::span<const ControlPoint> points) {
  is_automatic_ = true;
  follow(points);
}

}  // namespace nutik::studio
