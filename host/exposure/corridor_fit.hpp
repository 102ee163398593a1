// The fewest straight pieces that stay near a curve.
//
//        high ─────────╭────╮─────────      in:      samples of the curve at whole nanoseconds, a tolerance,
//              ╭──────○──────○╮                      and the range [low, high] that no gain may leave
//             ╱╭────╯   ╰────╮╲             out:     control points, each at the time of a sample, the first
//            ╱○ ╱          ╲  ○╲                     and the last on the curve
//           ╱╱ ╱            ╲ ╲ ╲           always:  at every sample the pieces lie within the tolerance,
//         ○╱  ╱              ╲ ╲ ○                   within the range, and on the curve's side of zero
#pragma once

#include <span>
#include <vector>

#include "exposure/gain_function.hpp"

namespace nutik {

// A polyline with the fewest corners among all whose corners lie at samples, on the curve or half a tolerance or a
// whole one above or below it, found by a breadth-first search: a corner a whole tolerance outside a bend lets a piece
// be √2 times as long as one that starts and ends on the curve. Among those with so few corners it is one that needs
// the least tolerance, to 1 %. Takes time in proportion to the samples and to how many of them one piece spans.
//
// `samples` are two or more, in order of time. Inside, where a sample is not 0, no corner is 0 or of the other sign, so
// that the function is zero where the curve is, and nowhere else.
[[nodiscard]] std::vector<ControlPoint> fit_corridor(std::span<const ControlPoint> samples, double tolerance,
                                                     double low, double high);

}  // namespace nutik
