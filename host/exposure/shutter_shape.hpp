// Shutter shapes: how far a shutter is open in the course of an exposure, as gain functions.
//
//   box              open all the time
//   trapezoid:R      opens evenly over the first share R of the exposure and closes over the last (0 < R < 1/2)
//   triangle         opens to the middle, then closes
//   gaussian         exp(−x²/2σ²), σ being a sixth of the exposure, which ends at ±3σ with a gain of 0.011
//   hann             sin²(π x): opens and closes smoothly
//   strobe:N         N flashes, and between them N − 1 pauses of the same length
//   strobe:N,R       flashes that last a share R of the time from one to the next (0 < R < 1)
//   spline:X=G,…     smooth through gain G at share X of the exposure, from 0 to 1, without going beyond
//                    neighbouring gains (MonotoneSpline)
//
//   in:      a shape, an exposure in whole nanoseconds, an error
//   out:     a gain function that is 0 outside the exposure and whose control points lie at whole nanoseconds
//   always:  named shapes reach 1 and are nowhere below 0; the exposure is their whole width
//
// Shapes of straight lines are exact but for their corners' times, which are rounded to whole nanoseconds. The
// others become the fewest straight pieces that keep within the error, a share of the shape's largest
// |gain|, at all times (docs/reference/shutters.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "capture/rational.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

class ShutterShape {
 public:
  static constexpr double kDefaultError = 1e-3;
  static constexpr double kMinError = 1e-6;  // finer ones would take more control points than clips samples

  ShutterShape() = default;  // box

  // A name as above. Throws UsageError naming what is wrong.
  static ShutterShape parse(std::string_view text);
  [[nodiscard]] const std::string& text() const { return text_; }

  // The gain at share x of the exposure, 0 <= x <= 1; at a jump, that of the later side.
  [[nodiscard]] double gain(double x) const;
  [[nodiscard]] double largest_gain() const { return std::scalbn(std::max(-min_, max_), exponent_); }  // of |gain|

  // The function of an exposure [begin_ns, end_ns]. kMinError <= error < 1. Throws UsageError where it is too
  // short for the shape's corners, or for whole nanoseconds to keep within the error.
  [[nodiscard]] GainFunction function(Interval exposure, double error = kDefaultError) const;

  [[nodiscard]] bool is_curve() const { return corners_.empty(); }
  // Whether they are one shape, however it was written; of curves, whether they were written alike.
  friend bool operator==(const ShutterShape& a, const ShutterShape& b) {
    return a.corners_ == b.corners_ && (!a.is_curve() || a.text_ == b.text_);
  }

 private:
  // A corner of a shape of straight lines. Two at one place are a jump.
  struct Corner {
    Rational at;
    double gain;
    friend bool operator==(const Corner&, const Corner&) = default;
  };
  // A stretch of a curve with a bound on |second derivative|, in curve_'s unit per square of the exposure.
  struct Section {
    double begin;
    double end;
    double bend;
    bool is_zero;
  };

  static ShutterShape strobe(std::string_view flashes);
  static ShutterShape spline(std::string_view list);

  [[nodiscard]] std::vector<ControlPoint> straight_points(std::int64_t length_ns) const;
  [[nodiscard]] std::vector<ControlPoint> curved_points(std::int64_t length_ns, double error) const;
  [[noreturn]] void fail_too_short(std::int64_t length_ns, const std::string& why) const;

  std::string text_ = "box";
  std::vector<Corner> corners_{{{0, 1}, 1.0}, {{1, 1}, 1.0}};  // empty for a curve
  // Empty for straight lines. A curve's gain is curve_ x 2^exponent_, so that all that is computed stays near 1,
  // however large or small the gains are.
  std::function<double(double)> curve_;
  int exponent_ = 0;
  std::vector<Section> sections_;  // of a curve, from 0 to 1 without gaps
  double min_ = 0.0;               // the range of curve_
  double max_ = 1.0;
};

// A shape and its error, for exposure after exposure: a length is fitted once, for this shutter and its copies.
class Shutter {
 public:
  Shutter() : Shutter(ShutterShape(), ShutterShape::kDefaultError) {}
  Shutter(ShutterShape shape, double error);

  // As ShutterShape::function(). Safe for several threads at a time.
  [[nodiscard]] GainFunction function(Interval exposure) const;

  // Whether every exposure has the same function: of straight lines whatever the error.
  friend bool operator==(const Shutter& a, const Shutter& b);

 private:
  struct Fits;
  std::shared_ptr<Fits> fits_;
};

}  // namespace nutik
