// What lies under the pointer in the curve editor: points, the transform box of several, boxcars, the curve.
//
//   units:   pixels
//
//        ■──────■──────■  the box round selected points: its sides spread them in time, its top and bottom multiply
//        │  o      o   │  their gains, its corners do both, its inside moves them
//        ■      o      ■
//        ■──────■──────■
//        [=============]  a boxcar's bar in the lane at the bottom: its ends, and what is between them
#pragma once

#include <QPointF>
#include <QRectF>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exposure/shutter_shape.hpp"
#include "studio/curves/points.hpp"
#include "studio/time/time_axis.hpp"

namespace nutik::studio {

// The boxcars of a function: stretches of one gain between two steps, which are moved as one.
//
//   in:      control points with increasing times
//   out:     boxcars in time order; the points with one of them changed
//   always:  a boxcar that begins with the capture may lack its first step: [0:1], [10000000:1], [10000001:0]. It gets
//            one, [-1:0], as soon as its begin is moved

struct GainBoxcar {
  std::size_t first = 0, last = 0;  // points of its constant gain
  std::int64_t begin_ns = 0, end_ns = 0;
  double gain = 0.0;
  bool has_first_step = true;

  friend bool operator==(const GainBoxcar&, const GainBoxcar&) = default;
};

[[nodiscard]] std::vector<GainBoxcar> boxcars_of(const Points& points);

enum class BoxcarPart { whole, begin, end, gain };

// Its ends, or one of them, so much later; its gain stays. It stays as long as a nanosecond.
[[nodiscard]] Points with_boxcar_moved(const Points& points, const GainBoxcar& boxcar, BoxcarPart part,
                                       std::int64_t by_ns);

// Which gains the curve editor shows.
//
//   always:  low < high. The axis follows the gains by itself, with room above and below, until somebody zooms; it
//            stands still while something is dragged

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

  // The function that is shown. Does nothing while the axis was zoomed by hand.
  void follow(std::span<const ControlPoint> points);
  // Shows `factor` times as much; `fixed` stays where it is. Within what a double holds.
  void zoom(double factor, double fixed);
  void make_automatic(std::span<const ControlPoint> points);

 private:
  GainRange range_;
  bool is_automatic_ = true;
};

// Where a time and a gain lie in the curve editor, in pixels.
class PlotFrame {
 public:
  // `box`: the area between the axes, in a widget of this width.
  PlotFrame(const TimeAxis& axis, int width, const QRectF& box, GainRange gains)
      : axis_(&axis), width_(width), box_(box), gains_(gains) {}

  [[nodiscard]] const QRectF& box() const { return box_; }
  [[nodiscard]] const GainRange& gains() const { return gains_; }
  [[nodiscard]] double ns_per_pixel() const { return axis_->ns_per_pixel(width_); }
  [[nodiscard]] double gain_per_pixel() const { return (gains_.high - gains_.low) / box_.height(); }

  [[nodiscard]] double x_of(std::int64_t time_ns) const {
    return axis_->to_pixel(static_cast<double>(time_ns), width_);
  }
  [[nodiscard]] std::int64_t time_at(double x) const { return axis_->to_time(x, width_); }
  [[nodiscard]] double y_of(double gain) const {
    return box_.bottom() - (gain - gains_.low) / gain_per_pixel();
  }
  [[nodiscard]] double gain_at(double y) const { return gains_.low + (box_.bottom() - y) * gain_per_pixel(); }
  [[nodiscard]] QPointF place(const ControlPoint& point) const {
    return {x_of(point.time_ns), y_of(point.gain)};
  }

 private:
  const TimeAxis* axis_;
  int width_;
  QRectF box_;
  GainRange gains_;
};

inline constexpr double kReachPixels = 7;    // how near to a thing the pointer has to be
inline constexpr double kLanePixels = 12;    // height of the boxcars' lane
inline constexpr double kMinBarPixels = 26;  // a bar is never shorter, so that it can be seized
inline constexpr double kHandlePixels = 8;

// The nearest point within reach. Of points at one place the later one, a selected one before others.
[[nodiscard]] std::optional<std::size_t> point_under(const PlotFrame& frame, const Points& points,
                                                     const PointIndices& selected, QPointF at);
// Whether the curve passes within reach, elsewhere than along a step, in which there is no room for a point.
[[nodiscard]] bool is_on_curve(const PlotFrame& frame, const Points& points, QPointF at);
// Points whose places lie in a rectangle.
[[nodiscard]] PointIndices points_within(const PlotFrame& frame, const Points& points, const QRectF& area);

enum class BoxPart { inside, left, right, top, bottom, top_left, top_right, bottom_left, bottom_right };

// Which sides a part moves.
[[nodiscard]] constexpr bool moves_left(BoxPart part) {
  return part == BoxPart::left || part == BoxPart::top_left || part == BoxPart::bottom_left;
}
[[nodiscard]] constexpr bool moves_right(BoxPart part) {
  return part == BoxPart::right || part == BoxPart::top_right || part == BoxPart::bottom_right;
}
[[nodiscard]] constexpr bool moves_top(BoxPart part) {
  return part == BoxPart::top || part == BoxPart::top_left || part == BoxPart::top_right;
}
[[nodiscard]] constexpr bool moves_bottom(BoxPart part) {
  return part == BoxPart::bottom || part == BoxPart::bottom_left || part == BoxPart::bottom_right;
}

// Round two selected points and more.
class TransformBox {
 public:
  static std::optional<TransformBox> round(const PlotFrame& frame, const Points& points,
                                           const PointIndices& selected);

  [[nodiscard]] const QRectF& box() const { return box_; }
  // Where it is seized, as far as it has such a handle: points of one time cannot be spread, gains of 0 not multiplied.
  [[nodiscard]] std::vector<std::pair<BoxPart, QRectF>> handles() const;
  [[nodiscard]] std::optional<BoxPart> part_under(QPointF at) const;

  // Gains of the selected points.
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

 private:
  QRectF box_;
  bool is_long_ = false;
  double low_ = 0.0, high_ = 0.0;
};

struct BoxcarHandles {
  QRectF bar, begin, end;  // in the lane
  QRectF level;            // on the curve: its gain

  static BoxcarHandles of(const PlotFrame& frame, const GainBoxcar& boxcar, double lane_top);
};

struct BoxcarHit {
  GainBoxcar boxcar;
  BoxcarPart part = BoxcarPart::whole;
};
[[nodiscard]] std::optional<BoxcarHit> boxcar_under(const PlotFrame& frame,
                                                    const std::vector<GainBoxcar>& boxcars, double lane_top,
                                                    QPointF at);

}  // namespace nutik::studio
