#include "exposure/shutter_shape.hpp"

#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "exposure/corridor_fit.hpp"
#include "exposure/function_numbers.hpp"

namespace nutik {
namespace {

// A smooth curve through points that never leaves the range between neighbours: the monotone cubic
// interpolation of Fritsch and Butland (1984). Where a point is higher or lower than both neighbours the curve
// turns there; between points that are alike it is flat.

class MonotoneSpline {
 public:
  struct Knot {
    double at = 0.0;
    double value = 0.0;
    friend bool operator==(const Knot&, const Knot&) = default;
  };

  // Two knots or more, `at` strictly increasing.
  explicit MonotoneSpline(std::vector<Knot> knots);

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }
  // For `at` between the first and the last knot.
  [[nodiscard]] double operator()(double at) const;
  // The largest |second derivative| between knots i and i + 1: a cubic has it at one of them.
  [[nodiscard]] double largest_bend(std::size_t i) const;

 private:
  std::vector<Knot> knots_;
  std::vector<double> slopes_;  // at the knots
};

// The slope at an end, from the lines to the next two knots: that of the parabola through all three, kept
// within what is monotone.
double end_slope(double h0, double h1, double slope0, double slope1) {
  const double slope = ((2 * h0 + h1) * slope0 - h0 * slope1) / (h0 + h1);
  if (slope * slope0 <= 0.0) return 0.0;
  if (slope0 * slope1 <= 0.0 && std::fabs(slope) > 3 * std::fabs(slope0)) return 3 * slope0;
  return slope;
}

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

constexpr std::string_view kNames =
    "box, trapezoid:R, triangle, gaussian, hann, strobe:N[,R] or spline:0=G,…,1=G";
constexpr std::uint32_t kMaxFlashes = 1'000'000;
constexpr std::int64_t kFinestShare = 1'000'000;  // denominator of a flash's share
constexpr std::size_t kMaxKnots = 1000;

// A curve is sampled so closely that between two samples it leaves their chord by at most this share of the
// error: the fit may use up the rest.
constexpr double kChordShare = 0.01;

double hann(double x) {
  const double sine = std::sin(std::numbers::pi * std::min(x, 1.0 - x));  // exactly 0 at both ends
  return sine * sine;
}
constexpr double kHannBend = 2 * std::numbers::pi * std::numbers::pi;  // π² 2 cos(2πx) at its ends and middle

constexpr double kGaussianWidth = 6.0;  // of the exposure, in σ
double gaussian(double x) {
  const double deviations = kGaussianWidth * (x - 0.5);
  return std::exp(-0.5 * deviations * deviations);
}
constexpr double kGaussianBend = kGaussianWidth * kGaussianWidth;  // 1/σ², in the middle

std::int64_t time_at(const Rational& share, std::int64_t length_ns) {
  return round_half_up(static_cast<int128>(share.numerator) * length_ns, share.denominator);
}

}  // namespace

ShutterShape ShutterShape::parse(std::string_view text) {
  const auto colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  const std::string_view value =
      colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
  ShutterShape shape;
  const bool takes_value = name == "trapezoid" || name == "strobe" || name == "spline";
  if (name == "strobe") {
    shape = strobe(value);
  } else if (name == "spline") {
    shape = spline(value);
  } else if (name == "trapezoid") {
    const Rational ramp = Rational::parse(value, "the trapezoid's ramp");
    if (ramp.numerator <= 0 || 2 * ramp.numerator >= ramp.denominator) {
      throw UsageError(
          format("the trapezoid's ramp {} must be a share of the exposure between 0 and 0.5: trapezoid:0.25",
                 ramp.text()));
    }
    shape.corners_ = {{{0, 1}, 0.0},
                      {ramp, 1.0},
                      {Rational::of(ramp.denominator - ramp.numerator, ramp.denominator), 1.0},
                      {{1, 1}, 0.0}};
  } else if (name == "triangle") {
    shape.corners_ = {{{0, 1}, 0.0}, {{1, 2}, 1.0}, {{1, 1}, 0.0}};
  } else if (name == "gaussian" || name == "hann") {
    const bool is_hann = name == "hann";
    shape.corners_.clear();
    shape.curve_ = is_hann ? hann : gaussian;
    shape.sections_ = {{0.0, 1.0, is_hann ? kHannBend : kGaussianBend, false}};
  } else if (name != "box") {
    throw UsageError(format("shutter '{}' is not known; choose {}", text, kNames));
  }
  if (!takes_value && colon != std::string_view::npos) {
    throw UsageError(format("shutter '{}': {} takes no value", text, name));
  }
  shape.text_ = text;
  return shape;
}

ShutterShape ShutterShape::strobe(std::string_view text) {
  const auto comma = text.find(',');
  const std::string_view count = text.substr(0, comma);
  const std::uint32_t flashes = parsed<std::uint32_t>(count).value_or(0);
  if (flashes < 1 || flashes > kMaxFlashes) {
    throw UsageError(format("the strobe's number of flashes '{}' is no whole number of 1 … {}: strobe:5",
                            count, kMaxFlashes));
  }
  Rational open{1, 2};
  if (comma != std::string_view::npos) {
    open = Rational::parse(text.substr(comma + 1), "the strobe's share");
    if (open.numerator <= 0 || open.numerator >= open.denominator || open.denominator > kFinestShare) {
      throw UsageError(
          format("the strobe's flashes last a share {} of the time from one to the next; it must lie between "
                 "0 and 1, "
                 "in steps of {} or larger: strobe:5,0.1",
                 open.text(), Rational::of(1, kFinestShare).text()));
    }
  }
  ShutterShape shape;
  shape.corners_.clear();
  // From one flash to the next it is `denominator` parts, of which a flash takes `numerator`.
  const std::int64_t parts = (std::int64_t{flashes} - 1) * open.denominator + open.numerator;
  for (std::int64_t opens = 0; opens < parts; opens += open.denominator) {
    const std::int64_t closes = opens + open.numerator;
    if (opens > 0) shape.corners_.push_back({Rational::of(opens, parts), 0.0});
    shape.corners_.push_back({Rational::of(opens, parts), 1.0});
    shape.corners_.push_back({Rational::of(closes, parts), 1.0});
    if (closes < parts) shape.corners_.push_back({Rational::of(closes, parts), 0.0});
  }
  return shape;
}

ShutterShape ShutterShape::spline(std::string_view list) {
  constexpr std::string_view kExample = "spline:0=0,0.3=1,1=0";
  std::vector<MonotoneSpline::Knot> knots;
  for (std::string_view rest = list; !rest.empty() || knots.empty();) {
    const auto comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    const auto equals = item.find('=');
    if (equals == std::string_view::npos) {
      throw UsageError(format("the spline's point '{}' is not written SHARE=GAIN, as in {}", item, kExample));
    }
    const ReadNumber<double> gain = read_gain(item.substr(equals + 1));
    if (!gain.mistake.empty()) throw UsageError(format("the spline's point '{}': {}", item, gain.mistake));
    knots.push_back({Rational::parse(item.substr(0, equals), "the spline's share").value(), gain.value});
    if (knots.size() > 1 && knots.back().at <= knots[knots.size() - 2].at) {
      throw UsageError(format("the spline's share in '{}' is not above the one before it", item));
    }
    if (comma != std::string_view::npos && rest.empty()) {
      throw UsageError(format("the spline ends with a comma: '{}'", list));
    }
  }
  if (knots.size() < 2 || knots.size() > kMaxKnots || knots.front().at != 0.0 || knots.back().at != 1.0) {
    throw UsageError(
        format("a spline has 2 … {} points, the first at share 0 of the exposure and the last at 1: {}",
               kMaxKnots, kExample));
  }
  ShutterShape shape;
  shape.corners_.clear();
  double largest = 0.0;
  for (const auto& knot : knots) largest = std::max(largest, std::fabs(knot.value));
  if (largest == 0.0) throw UsageError("the spline is zero everywhere");
  std::vector<MonotoneSpline::Knot> scaled = knots;
  shape.exponent_ = std::ilogb(largest);
  for (auto& knot : scaled) knot.value = std::scalbn(knot.value, -shape.exponent_);
  const auto [least, most] = std::ranges::minmax(scaled, {}, &MonotoneSpline::Knot::value);
  shape.min_ = least.value;
  shape.max_ = most.value;
  const MonotoneSpline spline(std::move(scaled));
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const bool is_zero = knots[i].value == 0.0 && knots[i + 1].value == 0.0;
    shape.sections_.push_back({knots[i].at, knots[i + 1].at, spline.largest_bend(i), is_zero});
  }
  shape.curve_ = spline;
  return shape;
}

double ShutterShape::gain(double x) const {
  if (curve_) return std::scalbn(curve_(x), exponent_);
  std::size_t i = 1;
  while (i + 1 < corners_.size() && corners_[i].at.value() <= x) ++i;
  const double begin = corners_[i - 1].at.value(), end = corners_[i].at.value();
  if (begin == end) return corners_[i].gain;
  return corners_[i - 1].gain + (corners_[i].gain - corners_[i - 1].gain) * ((x - begin) / (end - begin));
}

void ShutterShape::fail_too_short(std::int64_t length_ns, const std::string& why) const {
  throw UsageError(format("an exposure of {} ns is too short for the shutter {}: {}", length_ns, text_, why));
}

std::vector<ControlPoint> ShutterShape::straight_points(std::int64_t length_ns) const {
  std::vector<ControlPoint> points;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::int64_t time_ns = time_at(corners_[i].at, length_ns);
    if (i > 0 && corners_[i].at != corners_[i - 1].at && time_ns <= points.back().time_ns) {
      fail_too_short(length_ns, "its corners would fall on the same nanosecond");
    }
    points.push_back({time_ns, corners_[i].gain});
  }
  return points;
}

std::vector<ControlPoint> ShutterShape::curved_points(std::int64_t length_ns, double error) const {
  const auto length = static_cast<double>(length_ns);
  const double allowed = error * std::max(-min_, max_);
  std::vector<ControlPoint> points;
  std::vector<ControlPoint> run;  // samples of sections that are not zero, one behind the other
  double chord = 0.0;             // how far the curve leaves the chords of samples
  const auto close_run = [&] {
    if (run.empty()) return;
    if (chord > allowed / 2) {
      fail_too_short(length_ns, format("control points a whole nanosecond apart cannot keep within {} of its "
                                       "largest gain",
                                       error));
    }
    const auto fit = fit_corridor(run, allowed - chord, min_, max_);
    points.insert(points.end(), fit.begin() + (points.empty() ? 0 : 1), fit.end());
    run.clear();
  };
  const auto bend_of = [&](std::size_t i) { return i < sections_.size() ? sections_[i].bend : 0.0; };
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& section = sections_[i];
    const std::int64_t begin_ns = std::llround(section.begin * length);
    const std::int64_t end_ns = std::llround(section.end * length);
    if (end_ns <= begin_ns)
      fail_too_short(length_ns, "points of its spline would fall on the same nanosecond");
    if (section.is_zero) {
      close_run();
      if (points.empty()) points.push_back({begin_ns, 0.0});
      points.push_back({end_ns, 0.0});
      continue;
    }
    const bool from_zero = i > 0 && sections_[i - 1].is_zero;
    const bool to_zero = i + 1 < sections_.size() && sections_[i + 1].is_zero;
    if (run.empty())
      run.push_back({begin_ns, from_zero ? 0.0 : curve_(static_cast<double>(begin_ns) / length)});
    const double wanted =
        std::ceil((section.end - section.begin) * std::sqrt(section.bend / (8 * kChordShare * allowed)));
    const auto steps =
        static_cast<std::int64_t>(std::clamp(wanted, 1.0, static_cast<double>(end_ns - begin_ns)));
    std::int64_t longest_ns = 0;
    for (std::int64_t step = 1; step <= steps; ++step) {
      const std::int64_t time_ns =
          begin_ns + round_half_up(static_cast<int128>(end_ns - begin_ns) * step, steps);
      longest_ns = std::max(longest_ns, time_ns - run.back().time_ns);
      run.push_back(
          {time_ns, step == steps && to_zero ? 0.0 : curve_(static_cast<double>(time_ns) / length)});
    }
    // Its own bend over a step, and its neighbours' over the half nanosecond that its ends were rounded by.
    const double gap = static_cast<double>(longest_ns) / length;
    chord = std::max(chord,
                     (section.bend * gap * gap + (bend_of(i - 1) + bend_of(i + 1)) / (length * length)) / 8);
  }
  close_run();
  for (ControlPoint& point : points) point.gain = std::scalbn(point.gain, exponent_);
  return points;
}

GainFunction ShutterShape::function(Interval exposure, double error) const {
  const std::int64_t length_ns = exposure.end_ns - exposure.begin_ns;
  std::vector<ControlPoint> points = curve_ ? curved_points(length_ns, error) : straight_points(length_ns);
  if (points.front().gain != 0.0) points.insert(points.begin(), {points.front().time_ns, 0.0});
  if (points.back().gain != 0.0) points.push_back({points.back().time_ns, 0.0});
  for (ControlPoint& point : points) point.time_ns += exposure.begin_ns;
  return GainFunction(std::move(points));
}

struct Shutter::Fits {
  Fits(ShutterShape of, double largest_error) : shape(std::move(of)), error(largest_error) {}

  const ShutterShape shape;
  const double error;
  std::mutex making;
  std::map<std::int64_t, GainFunction> by_length;  // starting at 0
};

Shutter::Shutter(ShutterShape shape, double error) : fits_(std::make_shared<Fits>(std::move(shape), error)) {}

GainFunction Shutter::function(Interval exposure) const {
  const std::int64_t length_ns = exposure.end_ns - exposure.begin_ns;
  const std::lock_guard lock(fits_->making);
  auto found = fits_->by_length.find(length_ns);
  if (found == fits_->by_length.end()) {
    found =
        fits_->by_length.emplace(length_ns, fits_->shape.function({0, length_ns}, fits_->error)).first;
  }
  return found->second.shifted(exposure.begin_ns);
}

bool operator==(const Shutter& a, const Shutter& b) {
  if (a.fits_ == b.fits_) return true;
  return a.fits_->shape == b.fits_->shape && (!a.fits_->shape.is_curve() || a.fits_->error == b.fits_->error);
}

}  // namespace nutik
