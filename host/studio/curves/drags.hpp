// What a drag in the curve editor makes of the points it began with.
//
//   in:      the points when the button went down, and how far the hand has come since
//   out:     points, what is said of them, and what they were drawn to
//   always:  nothing moves while the hand has not: what was pressed beside its middle stays beside it
#pragma once

#include <QPointF>
#include <QString>
#include <memory>
#include <optional>

#include "studio/curves/handles.hpp"
#include "studio/curves/snapping.hpp"

namespace nutik::studio {

// How far the hand has come, and how far from a target it is drawn to it. Elsewhere a drag ends at round numbers, so that
// function files hold no digits that nobody chose.
struct HandShift {
  double time_ns = 0.0;
  double gain = 0.0;  // upwards
  double time_step_ns = 1.0;
  double gain_step = 0.0;  // powers of ten; 0: none
  double time_reach_ns = 0.0;
  double gain_reach = 0.0;  // both 0: no snapping
  bool alone = false;       // a point without the other one of its step
};

struct Dragged {
  Points points;
  QString text;  // where it is: `400 ms, gain 0.5`
  std::optional<TimeSnap> time_snap;
  std::optional<GainSnap> gain_snap;
};

class Drag {
 public:
  virtual ~Drag() = default;
  [[nodiscard]] virtual Dragged by(const HandShift& shift) const = 0;
  // For the undo menu.
  [[nodiscard]] virtual QString name() const = 0;
  [[nodiscard]] const Points& begun_with() const { return points_; }

 protected:
  Drag(Points points, Snapper snapper) : points_(std::move(points)), snapper_(std::move(snapper)) {}

  Points points_;
  Snapper snapper_;
};

// Selected points, drawn to targets by the one that was pressed.
[[nodiscard]] std::unique_ptr<Drag> drag_points(Points points, PointIndices chosen, std::size_t pressed,
                                                Snapper snapper);
// Selected points by a part of the box round them.
[[nodiscard]] std::unique_ptr<Drag> drag_box(Points points, PointIndices chosen, const TransformBox& box,
                                             BoxPart part, Snapper snapper);
[[nodiscard]] std::unique_ptr<Drag> drag_boxcar(Points points, const BoxcarHit& hit, Snapper snapper);

// `400 ms, gain 0.5`: the digits that a hand can choose.
[[nodiscard]] QString point_text(const ControlPoint& point);
// The same of any place: with the digits that a pixel has.
[[nodiscard]] QString pointer_text(const ControlPoint& at, double ns_per_pixel);

}  // namespace nutik::studio
