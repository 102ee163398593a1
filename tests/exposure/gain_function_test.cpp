#include "exposure/gain_function.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/error.hpp"
#include "exposure/function_file.hpp"
#include "support/bounds.hpp"
#include "support/exact.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

constexpr std::int64_t kThreeSeconds = 3'000'000'000;

GainFunction parse(const std::string& line) {
  const FunctionFile file = parse_functions(line);
  EXPECT_FALSE(file.has_errors()) << file.report("test");
  return file.functions.begin()->second.function;
}

// The numbers at the end of docs/explanation/model.md: figures of the paper, over 3 s.
TEST(GainSummary, KnowsThePapersFigures) {
  const GainSummary difference = summarize(
      parse("M0{[0:0.0] , [1500000000:0.0] , [1500000001:-0.5] , [1516666000:-0.5] , [1533332000:1] ,"
            " [1566665000:1] , [1566665001:-0.5] , [1583331000:-0.5] , [1583331001:0.0] , [3000000000:0.0]}"),
      kThreeSeconds);
  EXPECT_EQ(difference.support_ns, 83'331'001);
  EXPECT_NEAR(std::scalbn(difference.integral_ns, difference.exponent), 20'833'500.75, 1e-8);
  EXPECT_NEAR(difference.still_gain(), 0.250009006, 5e-10);

  const GainSummary multiple = summarize(
      parse("M128{[0:1] , [10000000:1] , [10000001:0] , [399999999:0] , [400000000:1] , [410000000:1] ,"
            " [410000001:0] , [799999999:0] , [800000000:1] , [810000000:1] , [810000001:0] ,"
            " [999999999:0] , [1000000000:1] , [1010000000:1] , [1010000001:0]}"),
      kThreeSeconds);
  EXPECT_EQ(multiple.support_ns, 40'000'007);
  EXPECT_NEAR(multiple.integral_ns, 40'000'003.5, 1e-8);

  const GainSummary printed =
      summarize(parse("M0{[0:0], [1:1], [100000000:1], [1000000002:-25], [1010000000:-25], [1010000001:0]}"),
                kThreeSeconds);
  EXPECT_NEAR(printed.still_gain(), -10.84, 0.005);
  const GainSummary restored =
      summarize(parse("M0{[0:0], [1:1], [1000000000:1], [1000000002:-25], [1010000000:-25], [1010000001:0]}"),
                kThreeSeconds);
  EXPECT_EQ(restored.support_ns, 1'010'000'001);
  EXPECT_NEAR(std::scalbn(restored.integral_ns, restored.exponent), 750'000'013, 1e-6);
  EXPECT_NEAR(restored.still_gain(), 0.742574, 5e-7);

  const GainSummary blur = summarize(
      parse("M0{[0:0], [600000000:0], [800000000:2], [800000001:0], [1000000000:0]}"), kThreeSeconds);
  EXPECT_EQ(blur.support_ns, 200'000'001);
  EXPECT_EQ(std::scalbn(blur.integral_ns, blur.exponent), 200'000'001.0);
}

TEST(GainSummary, AgreesWithExactArithmetic) {
  double worst = 0.0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    const Timeline timeline = random_timeline(random, static_cast<std::uint64_t>(random.whole(1, 40)));
    const GainFunction function = random_function(random, timeline);
    const GainSummary summary = summarize(function, timeline.duration_ns());
    const ExactSummary exact = exact_summary(exact_gain(function, timeline.duration_ns()));
    ASSERT_EQ(summary.support_ns, exact.support_ns) << "seed " << seed;
    if (exact.support_ns == 0) continue;
    const Exact scale = exact.absolute_integral_ns;
    const Exact error = Exact(std::scalbn(summary.integral_ns, summary.exponent)) - exact.integral_ns;
    worst = std::max(worst, std::fabs((error / scale).convert_to<double>()) / kRoundoff64);
  }
  // A piece's integral costs three roundings, its two gains half a place each, the sum two more.
  EXPECT_LE(worst, 6.0);
  std::printf("worst error of an integral: %.2f u of its scale\n", worst);
}

TEST(GainSummary, FindsTheLiveInterval) {
  const auto live = [](const std::string& line) { return summarize(parse(line), 1000).live; };
  EXPECT_EQ(live("M0 [100:0], [200:1], [300:0], [400:0]"), (Interval{100, 300}));
  EXPECT_EQ(live("M0 [100:0], [150:0], [200:-1], [300:0]"), (Interval{150, 300}));
  EXPECT_EQ(live("M0 [100:1], [200:0]"), (Interval{0, 200}));
  EXPECT_EQ(live("M0 [100:0], [200:1]"), (Interval{100, 1000}));
  EXPECT_EQ(live("M0 [100:0], [200:0]"), (Interval{0, 0}));
  EXPECT_EQ(live("M0 [2000:0], [3000:1], [4000:0]"), (Interval{0, 0}));
  EXPECT_EQ(live("M0 [-50:0], [-10:1], [50:0]"), (Interval{0, 50}));
}

TEST(GainSummary, TellsWhatLiesOutsideTheCapture) {
  const auto summary = [](const std::string& line) { return summarize(parse(line), 1000); };
  EXPECT_TRUE(summary("M0 [-10:0], [-5:1], [5:0]").reaches_before_capture);
  EXPECT_TRUE(summary("M0 [500:0], [900:1], [1100:1], [1101:0]").reaches_after_capture);
  EXPECT_FALSE(summary("M0 [500:0], [900:1], [1000:1]").reaches_after_capture);
  // A jump at the capture's end or start, as a file has to write it.
  EXPECT_FALSE(summary("M0 [500:0], [900:1], [1000:1], [1001:0]").reaches_after_capture);
  EXPECT_TRUE(summary("M0 [500:0], [900:1], [1000:1], [1002:0]").reaches_after_capture);
  EXPECT_TRUE(summary("M0 [500:0], [900:1], [1001:1], [1002:0]").reaches_after_capture);
  EXPECT_FALSE(summary("M0 [-1:0], [0:1], [500:0]").reaches_before_capture);
  EXPECT_FALSE(summary("M0 [-10:0], [5:0], [6:1], [7:0], [2000:0]").reaches_before_capture);
  EXPECT_FALSE(summary("M0 [-10:0], [5:0], [6:1], [7:0], [2000:0]").reaches_after_capture);
  EXPECT_TRUE(summary("M0 [400:1],[410:1]").exposes_to_the_end);
  EXPECT_FALSE(summary("M0 [400:1],[410:0]").exposes_to_the_end);
}

// Far outside control points make large gains that almost cancel inside: still exact to the last place.
TEST(GainFunction, CutsPiecesExactly) {
  const GainFunction function({{-4'000'000'000'000'000'000, -3.7}, {4'000'000'000'000'000'000, 3.7}});
  const auto pieces = function.pieces(1'000'003);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].begin_gain, 0.0);
  const auto exact = exact_gain(function, 1'000'003);
  EXPECT_EQ(pieces[0].end_gain, exact.front().end.convert_to<double>());
}

TEST(GainFunction, JumpsWhereTwoPointsShareATime) {
  const GainFunction box = GainFunction::boxcar(100, 200, 2.0);
  const GainSummary summary = summarize(box, 1000);
  EXPECT_EQ(summary.support_ns, 100);
  EXPECT_EQ(summary.still_gain(), 2.0);
  EXPECT_EQ(summary.live, (Interval{100, 200}));
}

// Gains near the largest number a double holds, cut where the capture ends: gain times time would overflow.
TEST(GainFunction, HoldsHugeGainsAtTheCapturesEnd) {
  const GainFunction function({{0, 1e300}, {500'000'000, 1e300}, {500'000'001, 0.0}});
  EXPECT_DOUBLE_EQ(summarize(function, 33'333'333).still_gain(), 1e300);
  const GainFunction ramp({{0, 0.0}, {1'000'000'000, 1.6e308}});
  EXPECT_DOUBLE_EQ(summarize(ramp, 500'000'000).still_gain(), 0.4e308);
}

TEST(GainFunction, MovesAndScales) {
  const GainFunction function({{-5, 1.0}, {10, -2.0}, {10, 4.0}});
  EXPECT_EQ(function.shifted(7), GainFunction({{2, 1.0}, {17, -2.0}, {17, 4.0}}));
  EXPECT_EQ(function.shifted(-7).shifted(7), function);
  EXPECT_EQ(function.scaled(-0.5), GainFunction({{-5, -0.5}, {10, 1.0}, {10, -2.0}}));
}

TEST(GainFunction, RefusesToLeaveTheRangeOfNumbers) {
  const GainFunction function({{-5, 1e300}, {kLargestTimeNs, 0.0}});
  EXPECT_NO_THROW(static_cast<void>(function.shifted(-kLargestTimeNs + 5)));
  EXPECT_THROW(static_cast<void>(function.shifted(1)), InputError);
  for (const std::int64_t by_ns : {INT64_MIN, INT64_MIN + 1})
    EXPECT_THROW(static_cast<void>(function.shifted(by_ns)), InputError);
  EXPECT_THROW(GainFunction({{INT64_MIN, 0.0}, {0, 1.0}}), std::logic_error);
  EXPECT_THROW(static_cast<void>(function.scaled(1e10)), InputError);
}

TEST(GainFunction, IsStretchedAboutAPlaceThatStays) {
  const GainFunction function = parse("M0 [0:0], [100:1], [300:1], [301:0]");
  EXPECT_EQ(function.stretched({2, 1}, 100), parse("M0 [-100:0], [100:1], [500:1], [502:0]"));
  EXPECT_EQ(function.stretched({1, 1}, 12'345), function);
  EXPECT_EQ(function.stretched({3, 2}, 0).stretched({2, 3}, 0), function);  // exact where nothing is rounded
}

TEST(GainFunction, JumpsWhereStretchingBringsPointsTogether) {
  // 100 and 101 and 102 fall on 10: from the first's gain to the last's, whatever the middle one says.
  const GainFunction shrunk = parse("M0 [0:0], [100:1], [101:7], [102:3], [200:0]").stretched({1, 10}, 0);
  EXPECT_EQ(shrunk, GainFunction({{0, 0}, {10, 1}, {10, 3}, {20, 0}}));
  const GainFunction all = parse("M0 [1:4], [2:5], [3:6], [4:7]").stretched({1, 1000}, 0);
  EXPECT_EQ(all, GainFunction({{0, 4}, {0, 7}}));
}

TEST(GainFunction, RefusesToStretchOutOfTheRangeOfTimes) {
  const GainFunction late = parse("M0 [0:1], [4000000000000000000:0]");
  EXPECT_THROW(static_cast<void>(late.stretched({2, 1}, 0)), InputError);
  EXPECT_THROW(static_cast<void>(late.stretched({999'999'999, 1}, 0)), InputError);
  EXPECT_THROW(static_cast<void>(late.stretched({999'999'999, 1}, 4'000'000'000'000'000'000)), InputError);
  EXPECT_EQ(late.stretched({1, 2}, 0), parse("M0 [0:1], [2000000000000000000:0]"));
  EXPECT_THROW(static_cast<void>(late.stretched({0, 1}, 0)), std::logic_error);
}

}  // namespace
}  // namespace nutik::test
