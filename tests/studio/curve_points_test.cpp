// What hands do to control points, without a window: they keep their order, steps stay steps.
#include <gtest/gtest.h>

#include <random>

#include "session/requests/stated_moments.hpp"
#include "studio/curves/drags.hpp"
#include "studio/curves/handles.hpp"
#include "studio/curves/points.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

const Points kBoxcar{{99, 0.0}, {100, 1.0}, {200, 1.0}, {201, 0.0}};

Timeline hundred_a_second() { return Timeline::constant({100, 1}, {180, 1}, 100); }

TEST(CurvePoints, StepsAreMovedWhole) {
  EXPECT_EQ(moved(kBoxcar, {2}, {50, 0.0}), (Points{{99, 0.0}, {100, 1.0}, {250, 1.0}, {251, 0.0}}));
  EXPECT_EQ(moved(kBoxcar, {3}, {-150, 0.0}), (Points{{99, 0.0}, {100, 1.0}, {101, 1.0}, {102, 0.0}}))
      << "as far as there is room";
  EXPECT_EQ(moved(kBoxcar, {2}, {50, 0.5}, Steps::ignored),
            (Points{{99, 0.0}, {100, 1.0}, {200, 1.5}, {201, 0.0}}))
      << "alone it has no room";
  EXPECT_EQ(moved(kBoxcar, {3}, {50, 0.0}, Steps::ignored),
            (Points{{99, 0.0}, {100, 1.0}, {200, 1.0}, {251, 0.0}}));
  EXPECT_EQ(step_anchor(kBoxcar, 0), 1U);
  EXPECT_EQ(step_anchor(kBoxcar, 3), 2U);
}

TEST(CurvePoints, AreSpreadRoundAMomentAndStepsStaySteps) {
  EXPECT_EQ(spread(kBoxcar, {0, 1, 2, 3}, 3.0, 100), (Points{{99, 0.0}, {100, 1.0}, {400, 1.0}, {401, 0.0}}));
  EXPECT_EQ(spread(kBoxcar, {0, 1, 2, 3}, 0.1, 200),
            (Points{{189, 0.0}, {190, 1.0}, {200, 1.0}, {201, 0.0}}));
  const Points tight{{0, 0.0}, {10, 1.0}, {20, 1.0}, {25, 0.0}};
  const Points spread_out = spread(tight, {1, 2}, 10.0, 10);
  EXPECT_EQ(spread_out[2].time_ns, 24) << "up to the point behind";
}

TEST(CurvePoints, AreAddedOnTheCurveAndTakenAway) {
  const Points ramp{{0, 0.0}, {10, 1.0}};
  EXPECT_EQ(gain_at(ramp, -5), 0.0);
  EXPECT_EQ(gain_at(ramp, 4), 0.4);
  EXPECT_EQ(gain_at(ramp, 99), 1.0);
  const auto added = with_point(ramp, {4, gain_at(ramp, 4)});
  ASSERT_TRUE(added);
  EXPECT_EQ(added->index, 1U);
  EXPECT_EQ(added->points, (Points{{0, 0.0}, {4, 0.4}, {10, 1.0}}));
  EXPECT_FALSE(with_point(ramp, {10, 5.0})) << "there is one";
  EXPECT_EQ(without(added->points, {1}), ramp);
  EXPECT_FALSE(without(ramp, {0, 1})) << "none would be left";
  EXPECT_FALSE(with_point_set(ramp, 0, {10, 0.0})) << "points keep their order";
}

TEST(CurvePoints, StayInOrderWhateverIsDone) {
  constexpr std::uint32_t kSeed = 20261122;
  std::mt19937 random(kSeed);
  const auto number = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  for (int round = 0; round < 2000; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", round " << round);
    Points points;
    std::int64_t time_ns = number(-20, 20);
    for (int i = number(1, 8); i > 0; --i, time_ns += number(0, 2) == 0 ? 1 : number(1, 40))
      points.push_back({time_ns, number(-3, 3) * 0.5});
    PointIndices chosen;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (number(0, 1) == 1) chosen.push_back(i);
    if (chosen.empty()) chosen.push_back(0);
    Points after;
    switch (number(0, 2)) {
      case 0:
        after =
            moved(points, chosen, {number(-100, 100), 0.0}, number(0, 1) == 0 ? Steps::kept : Steps::ignored);
        break;
      case 1: after = spread(points, chosen, number(1, 40) * 0.1, points[chosen.front()].time_ns); break;
      default: {
        const auto boxcars = boxcars_of(points);
        if (boxcars.empty()) continue;
        after = with_boxcar_moved(points, boxcars.front(), static_cast<BoxcarPart>(number(0, 2)),
                                  number(-50, 50));
      }
    }
    for (std::size_t i = 0; i + 1 < after.size(); ++i) ASSERT_LT(after[i].time_ns, after[i + 1].time_ns);
  }
}

TEST(Boxcars, AreStretchesOfOneGainBetweenSteps) {
  ASSERT_EQ(boxcars_of(kBoxcar), (std::vector<GainBoxcar>{{1, 2, 100, 200, 1.0, true}}));
  const Points strobe{{0, 1.0}, {10, 1.0}, {11, 0.0}, {39, 0.0}, {40, -2.0}, {50, -2.0}, {51, 0.0}};
  const auto boxcars = boxcars_of(strobe);
  ASSERT_EQ(boxcars, (std::vector<GainBoxcar>{{0, 1, 0, 10, 1.0, false}, {4, 5, 40, 50, -2.0, true}}))
      << "the dark between them is none";
  EXPECT_EQ(with_boxcar_moved(strobe, boxcars[0], BoxcarPart::whole, 5),
            (Points{{4, 0.0}, {5, 1.0}, {15, 1.0}, {16, 0.0}, {39, 0.0}, {40, -2.0}, {50, -2.0}, {51, 0.0}}))
      << "one that began with the capture gets its first step";
  EXPECT_EQ(with_boxcar_moved(strobe, boxcars[1], BoxcarPart::end, 100).back(), (ControlPoint{151, 0.0}));
  EXPECT_EQ(with_boxcar_moved(strobe, boxcars[1], BoxcarPart::whole, -100)[4].time_ns, 13)
      << "up to the one before";
  EXPECT_TRUE(boxcars_of({{0, 0.0}, {10, 1.0}, {20, 1.0}, {30, 0.0}}).empty()) << "ramps are no steps";
}

TEST(Snapping, PrefersPointsOfFunctionsToSamples) {
  const Timeline timeline = hundred_a_second();
  FunctionSet functions;
  functions.emplace(0, GainFunction({{12'000'000, 0.25}}));
  functions.emplace(7, GainFunction({{14'000'000, 0.75}}));
  const Snapper snapper(&timeline, functions, 0);
  const auto at = [&](std::int64_t time_ns, double reach) {
    const auto snap = snapper.time(time_ns, reach);
    return snap ? snap->time_ns : -1;
  };
  EXPECT_EQ(at(14'900'000, 1e6), 14'000'000) << "the end of picture 1 at 15 ms is nearer";
  EXPECT_EQ(snapper.time(14'900'000, 1e6)->what, "point of M7");
  EXPECT_EQ(at(14'900'000, 5e5), 15'000'000);
  EXPECT_EQ(snapper.time(14'900'000, 5e5)->what, "end of picture 1");
  EXPECT_EQ(at(12'100'000, 1e5), -1) << "the moved function's own points are no targets";
  EXPECT_EQ(at(999'990'000, 1e5), 1'000'000'000);
  EXPECT_EQ(snapper.gain(0.97, 0.05)->gain, 1.0);
  EXPECT_EQ(snapper.gain(0.77, 0.05)->gain, 0.75);
  EXPECT_FALSE(snapper.gain(0.5, 0.05));
}

TEST(Drags, LeaveEverythingWhereTheHandHasNotMoved) {
  const Timeline timeline = hundred_a_second();
  const Points points{{1'234'567, 0.123456789}, {5'000'000, 1.0}};
  const auto drag = drag_points(points, {0}, 0, Snapper(&timeline, {}, 0));
  EXPECT_EQ(drag.by({0, 0, 1e6, 0.1, 0, 0, false}).points, points);
  const Points after = drag.by({1.0e6, 0.2, 1e5, 0.01, 0, 0, false}).points;
  EXPECT_EQ(after[0].time_ns, 2'200'000) << "dragged numbers are round";
  EXPECT_EQ(after[0].gain, 0.32);
}

TEST(GainAxis, ShowsAllGainsHoweverLarge) {
  GainAxis axis;
  axis.follow(Points{{0, -100.0}, {10, 4000.0}});
  EXPECT_LT(axis.range().low, -100.0);
  EXPECT_GT(axis.range().high, 4000.0);
  axis.zoom(0.5, 0.0);
  const GainRange zoomed = axis.range();
  axis.follow(Points{{0, 1.0}});
  EXPECT_EQ(axis.range(), zoomed) << "who zoomed by hand keeps it";
  for (int i = 0; i < 2000; ++i) axis.zoom(0.5, 3.0);
  EXPECT_LT(axis.range().low, axis.range().high);
  for (int i = 0; i < 4000; ++i) axis.zoom(2.0, 3.0);
  EXPECT_TRUE(std::isfinite(axis.range().low) && std::isfinite(axis.range().high));
  axis.make_automatic(Points{{0, 0.0}});
  EXPECT_GE(axis.range().high, 1.0) << "a function of zeros has an axis, too";
}

TEST(SampleTimes, StepThereAndBack) {
  const Timeline timeline = Timeline::constant({30'000, 1001}, Timeline::kFullShutter, 300);
  for (const std::int64_t time_ns : {std::int64_t{0}, std::int64_t{33'366'667}, std::int64_t{1'234'567'891},
                                     std::int64_t{-5}, timeline.duration_ns()}) {
    EXPECT_EQ(samples_later(samples_later(time_ns, 7, timeline), -7, timeline), time_ns) << time_ns;
  }
  EXPECT_EQ(samples_later(0, 1, timeline), timeline.start_ns(1));
  EXPECT_EQ(samples_later(timeline.start_ns(299), 1, timeline), timeline.duration_ns());
  EXPECT_EQ(nearest_sample_edge(timeline.start_ns(7) + 3, timeline), timeline.start_ns(7));
}

TEST(TypedNumbers, AreReadBackToTheLastDigit) {
  const Timeline timeline = hundred_a_second();
  for (const std::int64_t time_ns : {std::int64_t{0}, std::int64_t{400'000'001}, std::int64_t{-1},
                                     std::int64_t{1'500}, std::int64_t{12'345'678'901}}) {
    EXPECT_EQ(read_typed_time(exact_time_text(time_ns), timeline).value.value_or(-7), time_ns)
        << exact_time_text(time_ns).toStdString();
  }
  EXPECT_EQ(exact_time_text(400'000'001), "400.000001 ms");
  EXPECT_EQ(read_typed_time("37f", timeline).value, 370'000'000);
  EXPECT_EQ(read_typed_time("1/100 s", timeline).value, 10'000'000);
  const auto wrong = read_typed_time("10", timeline);
  EXPECT_FALSE(wrong.value);
  EXPECT_TRUE(wrong.mistake.contains("write a number and a unit")) << wrong.mistake.toStdString();
  EXPECT_TRUE(read_typed_time("100f", timeline).mistake.contains("outside the capture"));
  EXPECT_EQ(read_typed_length("2f", timeline).value, 20'000'000);
  EXPECT_FALSE(read_typed_length("0 ms", timeline).value);
  EXPECT_EQ(read_typed_gain("-2.5e2").value, -250.0);
  EXPECT_EQ(read_typed_gain("1,5").value, 1.5) << "a decimal comma";
  for (const char* text : {"1,234.5", "1.234,5", "1,234,567"})
    EXPECT_FALSE(read_typed_gain(text).value) << text << ": no commas between thousands";
  EXPECT_EQ(gain_text(0.1), "0.1");
}

}  // namespace
}  // namespace nutik::studio
