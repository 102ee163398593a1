// What a drag in the curve editor makes of the points it began with.
//
//   in:      the points when the button went down, and how far the hand has come since
//   out:     points, what is said of them, and what they were drawn to
//   always:  nothing moves while the hand has not: what was pressed beside its middle stays beside it
#pragma once

#include <QPointF>
#include <QString>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "render/render_plan.hpp"
#include "studio/curves/handles.hpp"
#include "studio/curves/points.hpp"

namespace nutik::studio {

// Times and gains that a drag is drawn to.
//
//   in:      where the hand is, and how far (in ns and in gain) a target may be
//   out:     the target, and what it is, to be said; none if nothing is near
//   always:  a point of a function, a mark or an end of the capture comes before samples, which may lie too densely to
//            leave anything else a chance
struct TimeSnap {
  std::int64_t time_ns = 0;
  QString what;  // `M128's point`, `start of picture 37`
};
struct GainSnap {
  double gain = 0.0;
  QString what;
};

class Snapper {
 public:
  // What of a capture and other functions there is to snap to. The timeline outlives the snapper.
  Snapper(const Timeline* timeline, const FunctionSet& functions, std::uint8_t moved_tag);

  // More of both: where a drag began, marks.
  void add_time(std::int64_t time_ns, const QString& what);
  void add_gain(double gain, const QString& what);

  [[nodiscard]] std::optional<TimeSnap> time(std::int64_t time_ns, double reach_ns) const;
  [[nodiscard]] std::optional<GainSnap> gain(double gain, double reach) const;

 private:
  const Timeline* timeline_;
  std::vector<TimeSnap> times_;  // increasing
  std::vector<GainSnap> gains_;
};

// How far the hand has come, and how far from a target it is drawn to it. Elsewhere a drag ends at round numbers, so
// that function files hold no digits that nobody chose.
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

struct Drag {
  QString name;  // for the undo menu
  std::function<Dragged(const HandShift&)> by;
};

// Selected points, drawn to targets by the one that was pressed.
[[nodiscard]] Drag drag_points(Points points, PointIndices chosen, std::size_t pressed, Snapper snapper);
// Selected points by a part of the box round them.
[[nodiscard]] Drag drag_box(Points points, PointIndices chosen, const TransformBox& box, BoxPart part,
                            Snapper snapper);
[[nodiscard]] Drag drag_boxcar(Points points, const BoxcarHit& hit, Snapper snapper);

// `400 ms, gain 0.5`: the digits that a hand can choose.
[[nodiscard]] QString point_text(const ControlPoint& point);
// The same of any place: with the digits that a pixel has.
[[nodiscard]] QString pointer_text(const ControlPoint& at, double ns_per_pixel);

}  // namespace nutik::studio
