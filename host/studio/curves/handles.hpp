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

#include <QRectF>
#include <optional>
#include <vector>

#include "studio/curves/boxcars.hpp"
#include "studio/curves/plot_frame.hpp"

namespace nutik::studio {

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
