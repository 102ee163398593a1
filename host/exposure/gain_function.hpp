// A gain function of time: piecewise linear, held constant before its first control point and after its
// last, possibly negative.
//
//   units:   time in whole nanoseconds from the start of the capture, gain dimensionless
//   always:  at least one control point; times do not decrease; at most two share a time: there the
//            function jumps from the first's gain to the second's
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/rational.hpp"

namespace nutik {

struct ControlPoint {
  std::int64_t time_ns = 0;
  double gain = 0.0;
  friend bool operator==(const ControlPoint&, const ControlPoint&) = default;
};

// A stretch on which the function is a straight line. begin_ns < end_ns.
struct GainPiece {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  double begin_gain = 0.0;
  double end_gain = 0.0;

  [[nodiscard]] bool is_zero() const { return begin_gain == 0.0 && end_gain == 0.0; }
  // The gain at a time within the piece.
  [[nodiscard]] double at(std::int64_t time_ns) const;
};

// [begin_ns, end_ns]; empty where they are equal.
struct Interval {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  [[nodiscard]] bool empty() const { return begin_ns >= end_ns; }
  friend bool operator==(const Interval&, const Interval&) = default;
};

class GainFunction {
 public:
  // Throws std::logic_error where the invariant above does not hold or a gain is not finite.
  explicit GainFunction(std::vector<ControlPoint> points);

  // `gain` on [begin_ns, end_ns], 0 elsewhere, with jumps at both ends.
  static GainFunction boxcar(std::int64_t begin_ns, std::int64_t end_ns, double gain = 1.0);

  [[nodiscard]] std::span<const ControlPoint> points() const { return points_; }
  [[nodiscard]] double first_gain() const { return points_.front().gain; }  // held before the first point
  [[nodiscard]] double last_gain() const { return points_.back().gain; }    // held after the last
  [[nodiscard]] double largest_gain() const;                                // of either sign, without it

  // The function on [0, duration_ns], piece by piece, without gaps. Gains at cut ends are exact to the
  // last place, however far outside the control points lie that they are interpolated from: everything
  // that is computed from pieces can then err in proportion to the gains within the capture.
  [[nodiscard]] std::vector<GainPiece> pieces(std::int64_t duration_ns) const;

  // The same function later (earlier where `by_ns` is negative), or with every gain times `factor`. Throws
  // InputError where a time or a gain leaves the range of numbers.
  [[nodiscard]] GainFunction shifted(std::int64_t by_ns) const;
  [[nodiscard]] GainFunction scaled(double factor) const;

  // The same function `factor` times as long, `fixed_ns` staying where it is; factor > 0. Times are rounded
  // to whole nanoseconds. Where control points fall together the function jumps there, from the gain of the
  // first of them to that of the last. Throws InputError where a time leaves the range of numbers.
  [[nodiscard]] GainFunction stretched(Rational factor, std::int64_t fixed_ns) const;

  friend bool operator==(const GainFunction&, const GainFunction&) = default;

 private:
  std::vector<ControlPoint> points_;
};

// What a function amounts to over the domain [0, duration_ns] of a capture.
struct GainSummary {
  // Gains are divided by 2^exponent before anything is summed, so that no sum overflows or loses digits
  // to subnormal numbers; 1 <= largest |gain| / 2^exponent < 2 (all 0 where the function is 0).
  int exponent = 0;
  double integral_ns = 0.0;           // ∫g, of scaled gains
  double absolute_integral_ns = 0.0;  // ∫|g|, of scaled gains
  std::int64_t support_ns = 0;        // D: length of { t in the domain : g(t) ≠ 0 }, exact

  // From the control point before the first non-zero one to the one after the last; to the domain's ends
  // where a held end is not zero. Clipped to the domain.
  Interval live;

  // Parts between control points that are not zero and lie outside the domain, where they do not count; not the
  // steps of 1 ns up to the capture's start and from its end on, which stand for jumps there.
  bool reaches_before_capture = false;
  bool reaches_after_capture = false;
  bool exposes_from_the_start = false;  // held at a gain that is not zero from the capture's start on
  bool exposes_to_the_end = false;      // held at a gain that is not zero up to the end of the capture

  // What a still scene is multiplied by: ∫g / D; 0 where D is 0.
  [[nodiscard]] double still_gain() const;
  // S = ∫|g| / D, the scale of errors; 0 where D is 0.
  [[nodiscard]] double error_scale() const;
};

[[nodiscard]] GainSummary summarize(const GainFunction& function, std::int64_t duration_ns);

// What a function comes to by itself, wherever pixels' delays put it: as summarize(), over the capture's domain and
// between the function's control points; so no part lies outside. Held ends count in the capture alone.
//
// A delayed exposure has its D and its normalization from here (docs/explanation/model.md, "Time maps"). For a function
// that lies within the capture they are those of an exposure without delays.
[[nodiscard]] GainSummary summarize_course(const GainFunction& function, std::int64_t duration_ns);

}  // namespace nutik
