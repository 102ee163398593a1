#include "exposure/shutter_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

// The gain of a function at any time; at a jump that of the later side.
double gain_at(const GainFunction& function, double time_ns) {
  const auto points = function.points();
  const auto after = std::upper_bound(
      points.begin(), points.end(), time_ns,
      [](double time, const ControlPoint& point) { return time < static_cast<double>(point.time_ns); });
  if (after == points.begin()) return points.front().gain;
  if (after == points.end()) return points.back().gain;
  const ControlPoint& before = *(after - 1);
  const double share =
      (time_ns - static_cast<double>(before.time_ns)) / static_cast<double>(after->time_ns - before.time_ns);
  return before.gain + (after->gain - before.gain) * share;
}

// How many straight pieces any function must have, jumps or not, that stays within `error` of a curve which
// bends one way only over [begin, end]: the line that fits such a stretch best errs by half of what the curve
// leaves its chord by, so pieces are made as long as that allows, from the left.
int fewest_pieces(const ShutterShape& shape, double begin, double end, double error) {
  constexpr int kSteps = 4000;
  const auto x = [&](int i) { return begin + (end - begin) * i / kSteps; };
  const auto fits = [&](int from, int to) {
    const double y0 = shape.gain(x(from)), slope = (shape.gain(x(to)) - y0) / (to - from);
    double leaves = 0.0;
    for (int i = from + 1; i < to; ++i)
      leaves = std::max(leaves, std::fabs(shape.gain(x(i)) - y0 - slope * (i - from)));
    return leaves / 2 <= error;
  };
  int pieces = 0;
  for (int from = 0; from < kSteps; ++pieces) {
    int to = from + 1;
    while (to < kSteps && fits(from, to + 1)) ++to;
    from = to;
  }
  return pieces;
}

struct Curve {
  const char* text;
  std::vector<double> turns;  // where it bends the other way from on, with both ends
};

const std::vector<Curve>& curves() {
  static const std::vector<Curve> all{
      {"hann", {0, 0.25, 0.75, 1}},
      {"gaussian", {0, 1.0 / 3, 2.0 / 3, 1}},
      {"spline:0=0,0.5=1,1=0", {}},
      {"spline:0=0.25,0.1=1,0.9=1,1=0.5", {}},
      {"spline:0=0,0.1=0.2,0.15=0.9,0.3=0.95,0.5=-2,0.95=0.1,1=0", {}},
      {"spline:0=0,0.2=0,0.4=1,0.6=1,0.8=0,1=0", {}},
      {"spline:0=2,1=-2", {}},
  };
  return all;
}

TEST(ShutterShape, CurvesStayWithinTheirError) {
  for (const Curve& curve : curves()) {
    const ShutterShape shape = ShutterShape::parse(curve.text);
    for (const double error : {1e-2, 1e-3, 1e-5}) {
      for (const std::int64_t length_ns : {10'007LL, 1'234'567LL, 40'000'000'000LL}) {
        const GainFunction function = shape.function({-77, length_ns - 77}, error);
        double worst = 0.0;
        constexpr int kSteps = 30'011;  // between nanoseconds, too
        for (int i = 0; i < kSteps; ++i) {
          const double x = (i + 0.5) / kSteps;
          const double time_ns = x * static_cast<double>(length_ns) - 77.0;
          worst = std::max(worst, std::fabs(gain_at(function, time_ns) - shape.gain(x)));
        }
        // The curve itself is evaluated to some units in the last place.
        EXPECT_LE(worst, error * shape.largest_gain() + 1e-13)
            << curve.text << ", error " << error << ", " << length_ns << " ns";
        const bool is_line = std::string_view(curve.text) == "spline:0=2,1=-2";
        EXPECT_GT(worst, is_line ? 0.0 : error * shape.largest_gain() / 2) << "too fine: " << curve.text;
        EXPECT_EQ(function.first_gain(), 0.0);
        EXPECT_EQ(function.last_gain(), 0.0);
        EXPECT_EQ(function.points().front().time_ns, -77);
        EXPECT_EQ(function.points().back().time_ns, length_ns - 77);
      }
    }
  }
}

TEST(ShutterShape, CurvesTakeAsFewPointsAsNeeded) {
  for (const Curve& curve : curves()) {
    if (curve.turns.empty()) continue;
    const ShutterShape shape = ShutterShape::parse(curve.text);
    for (const double error : {1e-2, 1e-3, 1e-4}) {
      // A piece may serve both sides of a turn.
      int fewest = 2 - static_cast<int>(curve.turns.size());
      for (std::size_t i = 0; i + 1 < curve.turns.size(); ++i) {
        fewest += fewest_pieces(shape, curve.turns[i], curve.turns[i + 1], error);
      }
      const GainFunction function = shape.function({0, 1'000'000'000}, error);
      int pieces = 0;
      const auto points = function.points();
      for (std::size_t i = 0; i + 1 < points.size(); ++i) pieces += points[i].time_ns < points[i + 1].time_ns;
      std::printf("%s within %g: %d pieces, no function has fewer than %d\n", curve.text, error, pieces,
                  fewest);
      EXPECT_GE(pieces, fewest);
      // What it costs that corners lie at samples, both ends on the curve, and none beyond the peak or zero.
      EXPECT_LE(pieces, fewest * 1.1 + 4) << curve.text << ", error " << error;
    }
  }
}

// A spline is fitted alike whatever its gains are measured in, as far as a double reaches.
TEST(ShutterShape, SplinesKeepTheirFormAtEveryScale) {
  const auto function = [](double unit) {
    const std::string text = format("spline:0=0,0.3={},0.7={},1=0", unit, -unit / 2);
    return ShutterShape::parse(text).function({0, 1'000'000});
  };
  const GainFunction plain = function(1.0);
  for (const int exponent : {-1000, -333, 500, 1023}) {
    const GainFunction scaled = function(std::scalbn(1.0, exponent));
    ASSERT_EQ(scaled.points().size(), plain.points().size()) << exponent;
    for (std::size_t i = 0; i < plain.points().size(); ++i) {
      EXPECT_EQ(scaled.points()[i].time_ns, plain.points()[i].time_ns);
      EXPECT_EQ(scaled.points()[i].gain, std::scalbn(plain.points()[i].gain, exponent));
    }
  }
  const GainFunction least = ShutterShape::parse("spline:0=0,0.5=5e-324,1=0").function({0, 1'000'000});
  EXPECT_TRUE(std::ranges::any_of(least.points(), [](const ControlPoint& point) { return point.gain > 0.0; }));
}

// D and the sign of the light that is added are the shape's own, whatever the error.
TEST(ShutterShape, CurvesAreZeroOnlyWhereTheyAre) {
  for (const char* text : {"hann", "gaussian", "spline:0=0,0.5=1,1=0", "spline:0=0,0.02=0.001,1=1"}) {
    const ShutterShape shape = ShutterShape::parse(text);
    for (const double error : {0.3, 1e-3}) {
      const GainFunction function = shape.function({1000, 1'001'000}, error);
      EXPECT_EQ(summarize(function, 2'000'000).support_ns, 1'000'000) << text;
      for (const ControlPoint& point : function.points()) {
        EXPECT_GE(point.gain, 0.0) << text;
        EXPECT_LE(point.gain, 1.0) << text;
      }
    }
  }
  const GainFunction plateaus =
      ShutterShape::parse("spline:0=0,0.2=0,0.4=1,0.6=1,0.8=0,1=0").function({0, 1'000'000}, 0.1);
  EXPECT_EQ(summarize(plateaus, 1'000'000).support_ns, 600'000);
}

TEST(ShutterShape, StraightShapesAreExact) {
  const auto function = [](const char* text, std::int64_t begin_ns, std::int64_t end_ns) {
    return ShutterShape::parse(text).function({begin_ns, end_ns});
  };
  EXPECT_EQ(function("box", 100, 200), GainFunction::boxcar(100, 200));
  EXPECT_EQ(function("triangle", 100, 200), GainFunction({{100, 0}, {150, 1}, {200, 0}}));
  EXPECT_EQ(function("trapezoid:0.1", 100, 200), GainFunction({{100, 0}, {110, 1}, {190, 1}, {200, 0}}));
  EXPECT_EQ(function("trapezoid:1/3", 0, 100), GainFunction({{0, 0}, {33, 1}, {67, 1}, {100, 0}}));
  EXPECT_EQ(function("strobe:1", 0, 9), GainFunction::boxcar(0, 9));
  EXPECT_EQ(function("strobe:2", 10, 40),
            GainFunction({{10, 0}, {10, 1}, {20, 1}, {20, 0}, {30, 0}, {30, 1}, {40, 1}, {40, 0}}));
  EXPECT_EQ(summarize(function("strobe:5", 0, 9'000), 9'000).support_ns, 5'000);
  EXPECT_EQ(function("strobe:5,0.5", 0, 9'000), function("strobe:5", 0, 9'000));
  EXPECT_EQ(summarize(function("strobe:11,0.1", 0, 10'100), 10'100).support_ns,
            1'100);                                                // 11 flashes of 100 ns
  EXPECT_EQ(ShutterShape::parse("strobe:2,1/4").gain(0.19), 1.0);  // open for 1/5, pause of 3/5
  EXPECT_EQ(ShutterShape::parse("strobe:2,1/4").gain(0.21), 0.0);
  EXPECT_EQ(ShutterShape::parse("strobe:2,1/4").gain(0.81), 1.0);
}

TEST(ShutterShape, GainFollowsTheDefinition) {
  EXPECT_EQ(ShutterShape().gain(0.3), 1.0);
  EXPECT_DOUBLE_EQ(ShutterShape::parse("triangle").gain(0.25), 0.5);
  EXPECT_NEAR(ShutterShape::parse("trapezoid:0.2").gain(0.95), 0.25, 1e-15);
  EXPECT_DOUBLE_EQ(ShutterShape::parse("hann").gain(0.25), 0.5);
  EXPECT_DOUBLE_EQ(ShutterShape::parse("gaussian").gain(0.5 + 1.0 / 6), std::exp(-0.5));
  EXPECT_EQ(ShutterShape::parse("strobe:2").gain(0.5), 0.0);
  EXPECT_EQ(ShutterShape::parse("strobe:2").gain(0.9), 1.0);
}

// A spline goes through its points, and between two of them stays between their gains.
TEST(ShutterShape, SplinesAreSmoothAndKeepBetweenTheirPoints) {
  const std::vector<std::pair<double, double>> points{{0, 0},      {0.1, 0.2}, {0.15, 0.9},
                                                      {0.3, 0.95}, {0.5, -2},  {1, 0}};
  const ShutterShape shape = ShutterShape::parse("spline:0=0,0.1=0.2,0.15=0.9,0.3=0.95,0.5=-2,1=0");
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto [x0, g0] = points[i];
    const auto [x1, g1] = points[i + 1];
    EXPECT_NEAR(shape.gain(x0), g0, 1e-15);
    EXPECT_NEAR(shape.gain(x1), g1, 1e-15);
    for (double x = x0; x <= x1; x += (x1 - x0) / 200) {
      EXPECT_GE(shape.gain(x), std::min(g0, g1) - 1e-15);
      EXPECT_LE(shape.gain(x), std::max(g0, g1) + 1e-15);
    }
    if (i == 0) continue;
    constexpr double kStep = 1e-7;  // its slope does not jump: 4/w² · Δg bounds its bend, ~ 1200 here
    const double before = (shape.gain(x0) - shape.gain(x0 - kStep)) / kStep;
    const double after = (shape.gain(x0 + kStep) - shape.gain(x0)) / kStep;
    EXPECT_NEAR(before, after, 3000 * kStep) << "at " << x0;
  }
}

TEST(ShutterShape, FollowsEachLengthOnce) {
  Shutter shutter(ShutterShape::parse("hann"), 1e-3);
  const GainFunction first = shutter.function({0, 1'000'000});
  EXPECT_EQ(shutter.function({5, 1'000'005}), first.shifted(5));
  EXPECT_EQ(shutter.function({0, 1'000'001}), ShutterShape::parse("hann").function({0, 1'000'001}, 1e-3));
}

TEST(ShutterShape, SaysWhatIsWrong) {
  const auto message = [](const char* text) {
    return message_of<UsageError>([&] { return ShutterShape::parse(text); });
  };
  EXPECT_EQ(
      message("boxes"),
      "shutter 'boxes' is not known; choose box, trapezoid:R, triangle, gaussian, hann, strobe:N[,R] or "
      "spline:0=G,…,1=G");
  EXPECT_EQ(message("hann:2"), "shutter 'hann:2': hann takes no value");
  EXPECT_EQ(message("trapezoid:0.5"),
            "the trapezoid's ramp 0.5 must be a share of the exposure between 0 and 0.5: trapezoid:0.25");
  expect_says(message("trapezoid"), "the trapezoid's ramp '' is not a number");
  for (const char* text : {"strobe:5,0", "strobe:5,1", "strobe:5,-0.1", "strobe:5,1/3000000"}) {
    EXPECT_NE(message(text).find("it must lie between 0 and 1"), std::string::npos) << text;
  }
  for (const char* text : {"strobe", "strobe:0", "strobe:2.5", "strobe:-1", "strobe:9999999"}) {
    EXPECT_NE(message(text).find("is no whole number of 1 … 1000000: strobe:5"), std::string::npos) << text;
  }
  expect_says(message("spline"), "is not written SHARE=GAIN");
  expect_says(message("spline:0=0,1=x"), "the spline's point '1=x'");
  expect_says(message("spline:0=0,0.5=1,0.5=2,1=0"), "is not above the one before it");
  expect_says(message("spline:0=0,0.5=1"), "the last at 1");
  expect_says(message("spline:0.1=0,1=1"), "the first at share 0");
  expect_says(message("spline:0=0,1=1,"), "ends with a comma");
  EXPECT_EQ(message("spline:0=0,1=0"), "the spline is zero everywhere");

  const auto too_short = [](const char* text, std::int64_t length_ns, double error) {
    return message_of<UsageError>([&] { return ShutterShape::parse(text).function({0, length_ns}, error); });
  };
  EXPECT_EQ(too_short("strobe:5", 8, 1e-3),
            "an exposure of 8 ns is too short for the shutter strobe:5: its corners would fall on the same "
            "nanosecond");
  EXPECT_EQ(too_short("strobe:5", 9, 1e-3), "");
  EXPECT_EQ(too_short("hann", 60, 1e-3),
            "an exposure of 60 ns is too short for the shutter hann: control points a whole nanosecond apart "
            "cannot "
            "keep within 0.001 of its largest gain");
  EXPECT_EQ(too_short("hann", 80, 1e-3), "");
}

}  // namespace
}  // namespace nutik::test
