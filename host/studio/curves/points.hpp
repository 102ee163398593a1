// The control points of one function as a hand changes them: values in, values out, nothing of windows.
//
//   units:   time in whole nanoseconds from the start of the capture
//   always:  what goes in has increasing times, and so has what comes out: a point never passes another one. Where an
//            edit asks for more it goes as far as there is room
//
// A jump is written as two points 1 ns apart, a step (docs/reference/functions.md). A step stays one: whoever moves one
// of its points in time moves the other one, too, unless it asks for the point alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exposure/shutter_shape.hpp"

namespace nutik::studio {

using Points = std::vector<ControlPoint>;
using PointIndices = std::vector<std::size_t>;  // increasing

struct PointShift {
  std::int64_t time_ns = 0;
  double gain = 0.0;
};

enum class Steps { kept, ignored };

// The function's gain, held beyond its ends.
[[nodiscard]] double gain_at(std::span<const ControlPoint> points, std::int64_t time_ns);

// The indices, and those of all points in steps with them.
[[nodiscard]] PointIndices with_whole_steps(const Points& points, const PointIndices& chosen);
// The point of its step that stands for the jump's moment: the one of the largest |gain|.
[[nodiscard]] std::size_t step_anchor(const Points& points, std::size_t point);

// Chosen points by so much later and higher.
[[nodiscard]] Points moved(const Points& points, const PointIndices& chosen, PointShift by,
                           Steps steps = Steps::kept);
// Chosen points `factor` times as far from a moment; factor > 0.
[[nodiscard]] Points spread(const Points& points, const PointIndices& chosen, double factor,
                            std::int64_t fixed_ns);
// Gains of chosen points times a factor.
[[nodiscard]] Points amplified(const Points& points, const PointIndices& chosen, double factor);

struct AddedPoint {
  Points points;
  std::size_t index = 0;
};
// None where there is a point at that time.
[[nodiscard]] std::optional<AddedPoint> with_point(const Points& points, ControlPoint added);
// Without the chosen ones. None where no point would be left: a function has one at least.
[[nodiscard]] std::optional<Points> without(const Points& points, const PointIndices& chosen);
// One point at exactly this time and gain. None where it would meet or pass a point beside it.
[[nodiscard]] std::optional<Points> with_point_set(const Points& points, std::size_t index, ControlPoint to);

}  // namespace nutik::studio
