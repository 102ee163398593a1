// Gain functions between two key frames, in numbers worked out by hand.
#include "exposure/key_frame_values.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/random_case.hpp"

namespace nutik::test {
namespace {

using Points = std::vector<ControlPoint>;

Points points_of(const GainFunction& function) {
  return {function.points().begin(), function.points().end()};
}

TEST(TimeBetween, IsRoundedHalfUpFromItsExactValue) {
  EXPECT_EQ(time_between(10, 20, {1, 4}), 13);  // 12.5
  EXPECT_EQ(time_between(-20, -10, {1, 4}), -17);  // -17.5
  EXPECT_EQ(time_between(20, 10, {1, 4}), 18);  // 17.5
  EXPECT_EQ(time_between(0, 100, {1, 3}), 33);
  EXPECT_EQ(time_between(-kLargestTimeNs, kLargestTimeNs, {kLargestTimeNs, 2 * kLargestTimeNs}), 0);
  EXPECT_EQ(time_between(7, 9, {5, 5}), 9);
}

TEST(FunctionBetween, MovesEachOfAsManyControlPoints) {
  const GainFunction a({{0, 0.0}, {100, 1.0}, {101, 0.0}}), b({{40, 0.0}, {300, -2.0}, {304, 0.0}});
  EXPECT_EQ(points_of(function_between(a, b, {1, 4})), (Points{{10, 0.0}, {150, 0.25}, {152, 0.0}}));
  EXPECT_EQ(function_between(a, b, {0, 4}), a);
  EXPECT_EQ(function_between(a, b, {4, 4}), b);
}

// a is 1 up to 100 and 0 from 200 on; b is 4 everywhere but has one control point.
TEST(FunctionBetween, MixesFunctionsWithOtherNumbersOfPoints) {
  const GainFunction a({{100, 1.0}, {200, 0.0}}), b({{150, 4.0}});
  EXPECT_EQ(points_of(function_between(a, b, {1, 4})), (Points{{100, 1.75}, {150, 1.375}, {200, 1.0}}));
}

TEST(FunctionBetween, KeepsWhatBothKeysAgreeOn) {
  const double large = std::numeric_limits<double>::max();
  const GainFunction a({{0, large}, {10, 0.1}}), b({{0, large}, {20, 0.1}});
  for (std::int64_t passed = 0; passed <= 7; ++passed) {
    const GainFunction between = function_between(a, b, {passed, 7});
    EXPECT_EQ(between.points()[0], (ControlPoint{0, large}));
    EXPECT_EQ(between.points()[1].gain, 0.1);
  }
}

// A jump of a boxcar, which function files do not have, is a step of 1 ns.
TEST(FunctionBetween, TakesJumpsForSteps) {
  const GainFunction a = GainFunction::boxcar(0, 100), b = GainFunction::boxcar(50, 350);
  EXPECT_EQ(points_of(function_between(a, b, {1, 2})),
            (Points{{24, 0.0}, {25, 1.0}, {225, 1.0}, {226, 0.0}}));
}

// However close the points of both keys are, those between them come in order.
TEST(FunctionBetween, NeverPutsTwoPointsAtOneTime) {
  constexpr std::uint64_t kSeed = 21;
  Random random(kSeed);
  for (int round = 0; round < 2000; ++round) {
    Points first, second;
    std::int64_t a = -5, b = 1000;
    const std::int64_t count = random.whole(1, 6);
    for (std::int64_t i = 0; i < count; ++i) {
      first.push_back({a += random.whole(1, 3), random.real(-2, 2)});
      second.push_back({b += random.whole(1, 900), random.real(-2, 2)});
    }
    const std::int64_t whole = random.whole(1, 1000);
    const GainFunction between =
        function_between(GainFunction(first), GainFunction(second), {random.whole(0, whole), whole});
    for (std::size_t i = 1; i < between.points().size(); ++i)
      ASSERT_LT(between.points()[i - 1].time_ns, between.points()[i].time_ns)
          << "seed " << kSeed << ", round " << round;
  }
}

}  // namespace
}  // namespace nutik::test
