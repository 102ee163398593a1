// A graph on a canvas: a box with two axes, marked at round numbers, in which lines and areas are drawn by their
// numbers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plot/canvas.hpp"

namespace nutik::plot {

struct Tick {
  double at = 0.0;  // in the axis's own unit, nanoseconds for times
  std::string label;
};

struct Ticks {
  std::vector<Tick> ticks;  // increasing, within the axis
  std::string unit;         // of the labels: `s`, `ms`, `µs`, `ns`; empty for numbers
};

// Marks at 1, 2 or 5 times a power of ten, about `most` of them and never more than that and one. Times
// are whole nanoseconds, shown with at most three decimals where a unit allows that. begin < end.
[[nodiscard]] Ticks time_ticks(std::int64_t begin_ns, std::int64_t end_ns, int most);
[[nodiscard]] Ticks number_ticks(double low, double high, int most);

// low < high.
struct Extent {
  double low = 0.0;
  double high = 1.0;

  [[nodiscard]] double length() const { return high - low; }
};

// What an axis for these values shows: 0 and all of them, with a little room where they do not end at 0.
// Never empty.
[[nodiscard]] Extent extent_with_zero(double low, double high);

class Graph {
 public:
  // `box` is the area between the axes; labels are drawn outside of it, left and below.
  Graph(Canvas& canvas, const Box& box, Extent x, Extent y);

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] Point place(Point value) const {
    return {box_.x + (value.x - x_.low) / x_.length() * box_.width,
            box_.bottom() - (value.y - y_.low) / y_.length() * box_.height};
  }

  void heading(std::string_view text);                           // above the box, at its left
  void note(std::string_view text);                              // above the box, at its right
  void grid(const Ticks& x, const Ticks& y);                     // behind everything else
  void x_axis(const Ticks& ticks, std::string_view label = {});  // numbers and label below the box
  void y_axis(const Ticks& ticks, std::string_view label = {});  // left of it
  void frame();                                                  // and a line at 0, where 0 is shown

  // Between points these run straight; two points at one x are a jump. Cut at the box.
  void line(std::span<const Point> values, const LineStyle& style);
  void band(double from_x, double to_x, Colour colour);  // over the whole height
  // Between the line and 0, in one colour above and another below.
  void area(std::span<const Point> values, Colour above, Colour below);

 private:
  Canvas& canvas_;
  Box box_;
  Extent x_;
  Extent y_;
};

}  // namespace nutik::plot
