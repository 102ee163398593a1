#include "exposure/gain_function.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/compensated_sum.hpp"

namespace nutik {
namespace {

bool lies_outside(int128 time_ns) { return time_ns > kLargestTimeNs || time_ns < -kLargestTimeNs; }

}  // namespace

double GainPiece::at(std::int64_t time_ns) const {
  if (begin_gain == end_gain) return begin_gain;
  const auto length = static_cast<double>(end_ns - begin_ns);
  const auto before = static_cast<double>(time_ns - begin_ns);
  const auto after = static_cast<double>(end_ns - time_ns);
  return begin_gain * (after / length) + end_gain * (before / length);
}

GainFunction::GainFunction(std::vector<ControlPoint> points) : points_(std::move(points)) {
  if (points_.empty()) throw std::logic_error("a gain function needs a control point");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!std::isfinite(points_[i].gain)) throw std::logic_error("a gain is not finite");
    if (lies_outside(points_[i].time_ns)) throw std::logic_error("a time is too large");
    if (i >= 1 && points_[i].time_ns < points_[i - 1].time_ns) {
      throw std::logic_error("control points are not in time order");
    }
    if (i >= 2 && points_[i].time_ns == points_[i - 2].time_ns) {
      throw std::logic_error("more than two control points share a time");
    }
  }
}

double GainFunction::largest_gain() const {
  double largest = 0.0;
  for (const ControlPoint& point : points_) largest = std::max(largest, std::fabs(point.gain));
  return largest;
}

GainFunction GainFunction::boxcar(std::int64_t begin_ns, std::int64_t end_ns, double gain) {
  return GainFunction({{begin_ns, 0.0}, {begin_ns, gain}, {end_ns, gain}, {end_ns, 0.0}});
}

namespace {

// The gain at a time within a piece, to the last place: the numerator gain·time + gain·time is summed
// from exact products of factors that fit a double. Gains are scaled by a power of two, lest a product overflows.
double interpolate_exactly(const GainPiece& piece, std::int64_t time_ns) {
  const double largest = std::max(std::fabs(piece.begin_gain), std::fabs(piece.end_gain));
  if (largest == 0.0) return 0.0;
  const int exponent = std::ilogb(largest);
  CompensatedSum numerator;
  const auto add_product = [&](double gain, std::int64_t factor_ns) {
    const std::int64_t low = factor_ns & 0xFFFF'FFFF;
    for (const std::int64_t part : {factor_ns - low, low}) {
      const auto factor = static_cast<double>(part);
      const double product = gain * factor;
      numerator.add(product);
      numerator.add(std::fma(gain, factor, -product));
    }
  };
  add_product(std::scalbn(piece.begin_gain, -exponent), piece.end_ns - time_ns);
  add_product(std::scalbn(piece.end_gain, -exponent), time_ns - piece.begin_ns);
  return std::scalbn(numerator.value() / static_cast<double>(piece.end_ns - piece.begin_ns), exponent);
}

// ∫|g| over a piece, of scaled gains.
double absolute_integral(const GainPiece& piece, double begin_gain, double end_gain) {
  const auto length = static_cast<double>(piece.end_ns - piece.begin_ns);
  const double begin = std::fabs(begin_gain);
  const double end = std::fabs(end_gain);
  if ((begin_gain < 0) == (end_gain < 0) || begin == 0 || end == 0) return length * (begin + end) / 2;
  return length * (begin * begin + end * end) / (2 * (begin + end));  // two triangles
}

Interval live_interval(const GainFunction& function, std::int64_t duration_ns) {
  const auto points = function.points();
  const auto is_live = [](const ControlPoint& point) { return point.gain != 0.0; };
  const auto first = std::find_if(points.begin(), points.end(), is_live);
  if (first == points.end()) return {};
  const auto last = std::find_if(points.rbegin(), points.rend(), is_live).base() - 1;
  Interval live;
  live.begin_ns = first == points.begin() ? 0 : (first - 1)->time_ns;
  live.end_ns = last + 1 == points.end() ? duration_ns : (last + 1)->time_ns;
  live.begin_ns = std::clamp<std::int64_t>(live.begin_ns, 0, duration_ns);
  live.end_ns = std::clamp<std::int64_t>(live.end_ns, 0, duration_ns);
  return live.empty() ? Interval{} : live;
}

}  // namespace

GainFunction GainFunction::shifted(std::int64_t by_ns) const {
  std::vector<ControlPoint> points = points_;
  for (ControlPoint& point : points) {
    if (lies_outside(static_cast<int128>(point.time_ns) + by_ns)) {
      throw InputError(
          format("a control point at {} ns moved by {} ns lies outside what times can be (±{} ns)",
                 point.time_ns, by_ns, kLargestTimeNs));
    }
    point.time_ns += by_ns;
  }
  return GainFunction(std::move(points));
}

GainFunction GainFunction::scaled(double factor) const {
  std::vector<ControlPoint> points = points_;
  for (ControlPoint& point : points) {
    const double gain = point.gain * factor;
    if (!std::isfinite(gain)) {
      throw InputError(format("a gain of {} times {} is no finite number", point.gain, factor));
    }
    // It would count no more in D.
    if (gain == 0.0 && point.gain != 0.0 && factor != 0.0) {
      throw InputError(format("a gain of {} times {} is too small for a number", point.gain, factor));
    }
    point.gain = gain;
  }
  return GainFunction(std::move(points));
}

GainFunction GainFunction::stretched(Rational factor, std::int64_t fixed_ns) const {
  if (factor.numerator <= 0) throw std::logic_error("a function cannot be stretched to nothing");
  std::vector<ControlPoint> points;
  for (const ControlPoint& point : points_) {
    // The product fits 128 bits; that its quotient fits 64 has to be seen before it is rounded to them.
    const int128 product = (static_cast<int128>(point.time_ns) - fixed_ns) * factor.numerator;
    const bool is_outside = lies_outside(product / factor.denominator + fixed_ns);
    const std::int64_t time_ns = is_outside ? 0 : round_half_up(product, factor.denominator) + fixed_ns;
    if (is_outside || lies_outside(time_ns)) {
      throw InputError(format(
          "a control point at {} ns stretched by {} about {} ns lies outside what times can be (±{} ns)",
          point.time_ns, factor.text(), fixed_ns, kLargestTimeNs));
    }
    // Where three lie at one time, the one in the middle has no say.
    const std::size_t count = points.size();
    if (count >= 2 && points[count - 2].time_ns == time_ns) points.pop_back();
    points.push_back({time_ns, point.gain});
  }
  return GainFunction(std::move(points));
}

std::vector<GainPiece> GainFunction::pieces(std::int64_t duration_ns) const {
  std::vector<GainPiece> pieces;
  pieces.reserve(points_.size() + 1);
  const auto append = [&](const GainPiece& whole) {
    GainPiece clipped = whole;
    clipped.begin_ns = std::max<std::int64_t>(whole.begin_ns, 0);
    clipped.end_ns = std::min(whole.end_ns, duration_ns);
    if (clipped.begin_ns >= clipped.end_ns) return;
    if (clipped.begin_ns != whole.begin_ns) {
      clipped.begin_gain = interpolate_exactly(whole, clipped.begin_ns);
    }
    if (clipped.end_ns != whole.end_ns) clipped.end_gain = interpolate_exactly(whole, clipped.end_ns);
    pieces.push_back(clipped);
  };
  append({0, points_.front().time_ns, first_gain(), first_gain()});
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    append({points_[i].time_ns, points_[i + 1].time_ns, points_[i].gain, points_[i + 1].gain});
  }
  append({points_.back().time_ns, duration_ns, last_gain(), last_gain()});
  return pieces;
}

GainSummary summarize(const GainFunction& function, std::int64_t duration_ns) {
  GainSummary summary;
  const std::vector<GainPiece> pieces = function.pieces(duration_ns);
  double largest = 0.0;
  for (const GainPiece& piece : pieces) {
    largest = std::max({largest, std::fabs(piece.begin_gain), std::fabs(piece.end_gain)});
  }
  summary.exponent = largest > 0.0 ? std::ilogb(largest) : 0;
  CompensatedSum integral, absolute;
  for (const GainPiece& piece : pieces) {
    if (piece.is_zero()) continue;
    const double begin = std::scalbn(piece.begin_gain, -summary.exponent);
    const double end = std::scalbn(piece.end_gain, -summary.exponent);
    const std::int64_t length_ns = piece.end_ns - piece.begin_ns;
    integral.add(static_cast<double>(length_ns) * (begin + end) / 2);
    absolute.add(absolute_integral(piece, begin, end));
    summary.support_ns += length_ns;
  }
  summary.integral_ns = integral.value();
  summary.absolute_integral_ns = absolute.value();
  summary.live = live_interval(function, duration_ns);
  const auto points = function.points();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const bool is_zero = points[i].gain == 0.0 && points[i + 1].gain == 0.0;
    if (is_zero || points[i].time_ns == points[i + 1].time_ns) continue;
    const bool steps_to_start = points[i].time_ns == -1 && points[i + 1].time_ns == 0;
    summary.reaches_before_capture |= points[i].time_ns < 0 && !steps_to_start;
    const bool steps_from_end = points[i].time_ns == duration_ns && points[i + 1].time_ns == duration_ns + 1;
    summary.reaches_after_capture |= points[i + 1].time_ns > duration_ns && !steps_from_end;
  }
  summary.exposes_from_the_start = function.first_gain() != 0.0 && points.front().time_ns > 0;
  summary.exposes_to_the_end = function.last_gain() != 0.0 && points.back().time_ns < duration_ns;
  return summary;
}

double GainSummary::still_gain() const {
  return support_ns == 0 ? 0.0 : std::scalbn(integral_ns / static_cast<double>(support_ns), exponent);
}

double GainSummary::error_scale() const {
  return support_ns == 0 ? 0.0
                         : std::scalbn(absolute_integral_ns / static_cast<double>(support_ns), exponent);
}

GainSummary summarize_course(const GainFunction& function, std::int64_t duration_ns) {
  std::vector<ControlPoint> points(function.points().begin(), function.points().end());
  const std::int64_t first_ns = points.front().time_ns, last_ns = points.back().time_ns;
  // Held ends expose within the capture alone: between it and the control points the course is 0.
  if (first_ns > duration_ns) {
    if (points.size() > 1 && points[1].time_ns == first_ns) points.erase(points.begin());
    points.insert(points.begin(), {{duration_ns, function.first_gain()}, {duration_ns, 0.0}, {first_ns, 0.0}});
  }
  if (last_ns < 0) {
    if (points.size() > 1 && points[points.size() - 2].time_ns == last_ns) points.pop_back();
    points.insert(points.end(), {{last_ns, 0.0}, {0, 0.0}, {0, function.last_gain()}});
  }
  const std::int64_t begin_ns = std::min<std::int64_t>(0, first_ns);
  GainSummary summary =
      summarize(GainFunction(std::move(points)).shifted(-begin_ns), std::max(duration_ns, last_ns) - begin_ns);
  if (!summary.live.empty()) {
    summary.live = {summary.live.begin_ns + begin_ns, summary.live.end_ns + begin_ns};
  }
  return summary;
}

}  // namespace nutik
