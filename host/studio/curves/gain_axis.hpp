// Which gains the curve editor shows.
//
//   always:  low < high. The axis follows the gains by itself, with room above and below, until somebody zooms; it
//            stands still while something is dragged
#pragma once

#include <span>

#include "session/below/functions.hpp"

namespace nutik::studio {

struct GainRange {
  double low = 0.0;
  double high = 1.0;
  friend bool operator==(const GainRange&, const GainRange&) = default;
};

// 0, 1 where that is near, and all gains of the function, with padding: never empty.
[[nodiscard]] GainRange range_with_room(std::span<const ControlPoint> points);

class GainAxis {
 public:
  [[nodiscard]] const GainRange& range() const { return range_; }
  [[nodiscard]] bool is_automatic() const { return is_automatic_; }

  // The function that is shown. Does nothing while the axis was zoomed by hand.
  void follow(std::span<const ControlPoint> points);
  // Shows `factor` times as much; `fixed` stays where it is. Within what a double holds.
  void zoom(double factor, double fixed);
  void make_automatic(std::span<const ControlPoint> points);

 private:
  GainRange range_;
  bool is_automatic_ = true;
};

}  // namespace nutik::studio
