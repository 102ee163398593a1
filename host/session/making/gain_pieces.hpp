// A gain function that is put together from pieces.
#pragma once

#include <vector>

#include "exposure/function_text.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

// Gains of pieces of a function, each of its own interval. In time order.
class GainPieces {
 public:
  void add(Interval interval, double begin_gain, double end_gain) {
    if (!points_.empty() && points_.back().time_ns == interval.begin_ns) {
      points_.pop_back();  // it goes on from the piece before it
      if (points_.back().gain == begin_gain) points_.pop_back();
    } else {
      points_.push_back({interval.begin_ns, 0.0});
    }
    if (points_.empty() || points_.back().gain != begin_gain)
      points_.push_back({interval.begin_ns, begin_gain});
    points_.push_back({interval.end_ns, end_gain});
    points_.push_back({interval.end_ns, 0.0});
  }
  [[nodiscard]] GainFunction function() const { return with_steps(GainFunction(points_)); }

 private:
  std::vector<ControlPoint> points_;
};

}  // namespace nutik
