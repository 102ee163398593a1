#include "exposure/monotone_spline.hpp"

#include <algorithm>
#include <cmath>

namespace nutik {
namespace {

// The slope at an end, from the lines to the next two knots: that of the parabola through all three, kept
// within what is monotone.
double end_slope(double h0, double h1, double slope0, double slope1) {
  const double slope = ((2 * h0 + h1) * slope0 - h0 * slope1) / (h0 + h1);
  if (slope * slope0 <= 0.0) return 0.0;
  if (slope0 * slope1 <= 0.0 && std::fabs(slope) > 3 * std::fabs(slope0)) return 3 * slope0;
  return slope;
}

}  // namespace

MonotoneSpline::MonotoneSpline(std::vector<Knot> knots) : knots_(std::move(knots)), slopes_(knots_.size()) {
  const std::size_t last = knots_.size() - 1;
  const auto width = [&](std::size_t i) { return knots_[i + 1].at - knots_[i].at; };
  const auto secant = [&](std::size_t i) { return (knots_[i + 1].value - knots_[i].value) / width(i); };
  if (last == 1) {
    slopes_.assign(2, secant(0));
    return;
  }
  for (std::size_t i = 1; i < last; ++i) {
    const double before = secant(i - 1), after = secant(i);
    if (before * after <= 0.0) continue;  // a turn: flat
    const double w0 = 2 * width(i) + width(i - 1), w1 = width(i) + 2 * width(i - 1);
    slopes_[i] = (w0 + w1) / (w0 / before + w1 / after);
  }
  slopes_[0] = end_slope(width(0), width(1), secant(0), secant(1));
  slopes_[last] = end_slope(width(last - 1), width(last - 2), secant(last - 1), secant(last - 2));
}

double MonotoneSpline::operator()(double at) const {
  const auto behind = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, at,
                                       [](double x, const Knot& knot) { return x < knot.at; });
  const auto i = static_cast<std::size_t>(behind - knots_.begin()) - 1;
  const Knot& left = knots_[i];
  const Knot& right = knots_[i + 1];
  const double width = right.at - left.at;
  const double t = (at - left.at) / width;
  const double s = 1.0 - t;
  return s * s * (left.value * (1 + 2 * t) + slopes_[i] * width * t) +
         t * t * (right.value * (1 + 2 * s) - slopes_[i + 1] * width * s);
}

double MonotoneSpline::largest_bend(std::size_t i) const {
  const double width = knots_[i + 1].at - knots_[i].at;
  const double secant = (knots_[i + 1].value - knots_[i].value) / width;
  return std::max(std::fabs(6 * secant - 4 * slopes_[i] - 2 * slopes_[i + 1]),
                  std::fabs(6 * secant - 2 * slopes_[i] - 4 * slopes_[i + 1])) /
         width;
}

}  // namespace nutik
