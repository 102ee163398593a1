#include "exposure/normalization.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/error.hpp"
#include "support/bounds.hpp"
#include "support/exact.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

GainFunction normalized(const char* how, const GainFunction& function, std::int64_t duration_ns,
                        double gain = 1.0) {
  return Normalization::parse(how).normalized(function, duration_ns, gain, "M0");
}

// The function of the same control points with |gain|.
GainFunction magnitudes(const GainFunction& function) {
  std::vector<ControlPoint> points(function.points().begin(), function.points().end());
  for (ControlPoint& point : points) point.gain = std::fabs(point.gain);
  return GainFunction(std::move(points));
}

TEST(Normalization, IsWrittenAsItIsRead) {
  for (const char* text : {"support", "integral", "absolute", "seconds:0.5", "seconds:1/3", "seconds:2"}) {
    EXPECT_EQ(Normalization::parse(text).text(), text);
  }
  EXPECT_EQ(Normalization::parse("support"), Normalization());
}

TEST(Normalization, RefusesWhatItIsNot) {
  const auto message = [](const char* text) {
    return message_of<UsageError>([&] { return Normalization::parse(text); });
  };
  EXPECT_EQ(message("mean"),
            "normalization 'mean' is not known; choose support, integral, absolute or seconds:S, as in "
            "seconds:0.5");
  EXPECT_EQ(message("seconds:0"), "normalization 'seconds:0': the seconds must be more than 0");
  EXPECT_EQ(message("seconds:-1"), "normalization 'seconds:-1': the seconds must be more than 0");
  expect_says(message("seconds:"), "is not a number");
  expect_says(message("Integral"), "is not known");
}

TEST(Normalization, LeavesThePapersAlone) {
  const GainFunction function({{0, 0.3}, {70, -0.7}, {90, 0.0}});
  EXPECT_EQ(normalized("support", function, 1000), function);
  EXPECT_EQ(normalized("support", function, 1000, -2.5), function.scaled(-2.5));
}

// ∫ g' v / D with the normalized g' is gain · ∫ g v / X: in exact arithmetic, for a scene that brightens evenly,
// within the roundings of the factor and of each gain.
TEST(Normalization, DividesByWhatItSays) {
  double worst = 0.0;
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const Timeline timeline = random_timeline(random, static_cast<std::uint64_t>(random.whole(1, 40)));
    const std::int64_t duration_ns = timeline.duration_ns();
    const GainFunction function = random_function(random, timeline);
    const auto exact = exact_gain(function, duration_ns);
    const ExactSummary summary = exact_summary(exact);
    if (summary.support_ns == 0) continue;
    const std::vector<ExactStretch> light{{0, duration_ns, Exact(1, 5), Exact(1)}};
    const Exact exposed = integrate_product(exact, light);
    const double gain = random.pick<double>({1.0, 3.7, -0.25});
    const Exact seconds(std::int64_t{3} * kSecondNs, 7);
    const Exact cancels = Exact(abs(summary.integral_ns)) / summary.absolute_integral_ns;
    const Exact magnitude = exact_summary(exact_gain(magnitudes(function), duration_ns)).integral_ns;
    struct Wanted {
      const char* how;
      Exact divisor;
    };
    for (const Wanted& wanted :
         {Wanted{"integral", summary.integral_ns}, Wanted{"absolute", summary.absolute_integral_ns},
          Wanted{"seconds:3/7", seconds}, Wanted{"support", summary.support_ns}}) {
      if (wanted.divisor == summary.integral_ns && cancels.convert_to<double>() < 1e-3) continue;
      const GainFunction scaled = normalized(wanted.how, function, duration_ns, gain);
      const auto scaled_gain = exact_gain(scaled, duration_ns);
      ASSERT_EQ(exact_summary(scaled_gain).support_ns, summary.support_ns) << "seed " << seed;
      const Exact got = integrate_product(scaled_gain, light) / summary.support_ns;
      const Exact want = Exact(gain) * exposed / wanted.divisor;
      const Exact scale = Exact(abs(Exact(gain) * magnitude / wanted.divisor));
      double units = (Exact(abs(got - want)) / scale).convert_to<double>() / kRoundoff64;
      // An integral errs by 6 u of ∫|g| (see gain_function_test.cpp): of itself by so much more as it cancels.
      if (wanted.divisor == summary.integral_ns) units *= cancels.convert_to<double>();
      worst = std::max(worst, units);
      ++compared;
    }
  }
  // The divisor errs by 6 u, the quotient and its product with the gain by 1 u each, all of that the same for all
  // gains; then each gain rounds once more, which moves the function by 1 u of the line between their magnitudes.
  EXPECT_LE(worst, 6.0 + 2.0 + 1.0);
  EXPECT_GT(compared, 500);
  std::printf("worst error of a normalization: %.2f u of its scale, %d compared\n", worst, compared);
}

TEST(Normalization, KeepsAStillSceneWhereItDividesByTheIntegral) {
  const GainFunction triangle({{100, 0.0}, {300, 8.0}, {500, 0.0}});
  EXPECT_DOUBLE_EQ(summarize(normalized("integral", triangle, 1000), 1000).still_gain(), 1.0);
  EXPECT_DOUBLE_EQ(summarize(normalized("integral", triangle, 1000, 0.5), 1000).still_gain(), 0.5);
  // Also where the capture cuts it, and where the integral is negative.
  EXPECT_DOUBLE_EQ(summarize(normalized("integral", triangle, 250), 250).still_gain(), 1.0);
  EXPECT_DOUBLE_EQ(summarize(normalized("integral", triangle.scaled(-1), 1000), 1000).still_gain(), 1.0);
  EXPECT_DOUBLE_EQ(summarize(normalized("absolute", triangle.scaled(-1), 1000), 1000).still_gain(), -1.0);
  EXPECT_DOUBLE_EQ(summarize(normalized("seconds:1", triangle, 1000), 1000).still_gain(), 1600e-9);
}

TEST(Normalization, RefusesAnIntegralThatCancels) {
  // As people write it, with steps of 1 ns: what is left is half a nanosecond of 20 ms.
  const GainFunction difference(
      {{0, -1.0}, {10'000'000, -1.0}, {10'000'001, 1.0}, {20'000'000, 1.0}, {20'000'001, 0.0}});
  const std::string message = message_of<InputError>([&] { return normalized("integral", difference, kSecondNs); });
  EXPECT_EQ(
      message,
      "M0: the positive and negative parts of its gains cancel (the still gain is -2.5e-08), so there is no "
      "integral to divide by; use support, absolute or seconds:S");
  EXPECT_NO_THROW(static_cast<void>(normalized("absolute", difference, kSecondNs)));
}

TEST(Normalization, LeavesAFunctionThatIsZeroInTheCapture) {
  const GainFunction outside({{5000, 0.0}, {6000, 1.0}, {7000, 0.0}});
  for (const char* how : {"integral", "absolute", "seconds:1", "support"}) {
    EXPECT_EQ(normalized(how, outside, 1000, 2.0), outside) << how;
  }
}

TEST(Normalization, SaysWhereAGainLeavesTheRangeOfNumbers) {
  const GainFunction large({{0, 1e300}, {10, 1e300}, {10, 0.0}});
  EXPECT_EQ(message_of<InputError>([&] { return normalized("support", large, 1000, 1e20); }),
            "M0: a gain of 1e+300 times 1e+20 is no finite number");
  // A gain that became 0 would not count in D any more.
  const GainFunction small({{0, 1.0}, {10, 1.0}, {10, 1e-310}, {20, 1e-310}, {20, 0.0}});
  expect_error<InputError>([&] { return normalized("support", small, 1000, 1e-20); }, {"too small for a number"});
}

}  // namespace
}  // namespace nutik::test
