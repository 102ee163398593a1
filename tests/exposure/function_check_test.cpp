// Each finding: a function that has it, and one that is nearly the same and has not.
#include "exposure/function_check.hpp"

#include <gtest/gtest.h>

#include "exposure/function_file.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

using Kind = FunctionFinding::Kind;
constexpr std::int64_t kSecond = 1'000'000'000;

std::vector<FunctionFinding> check(const std::string& points, CheckedDomain domain = {kSecond, true}) {
  const FunctionFile file = parse_functions("M0 " + points);
  EXPECT_FALSE(file.has_errors()) << file.report("test");
  const GainFunction& function = file.functions.at(0).function;
  return check_function(function, summarize(function, domain.duration_ns), domain);
}

// Expects one finding of this kind whose message has this text, or none at all.
void expect_only(const std::vector<FunctionFinding>& findings, Kind kind, const std::string& text,
                 std::optional<std::size_t> point) {
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, kind) << to_text(findings[0].kind);
  expect_says(findings[0].message, text);
  EXPECT_EQ(findings[0].point, point);
}

TEST(FunctionCheck, ABoxcarIsSilent) {
  EXPECT_TRUE(check("[399999999:0], [400000000:1], [410000000:1], [410000001:0]").empty());
}

TEST(FunctionCheck, ZeroEverywhere) {
  expect_only(check("[0:0], [1:0]"), Kind::zero_everywhere, "zero everywhere in the capture (0 … 1 s)", {});
  expect_only(check("[0:0], [1:0]", {kSecond, false}), Kind::zero_everywhere, "zero everywhere; its", {});
  EXPECT_TRUE(check("[0:0], [1:1], [2:0]").empty());
}

TEST(FunctionCheck, PartsBeforeTheCapture) {
  expect_only(check("[-5:0], [-4:1], [1000:1], [1001:0]"), Kind::before_capture, "before the capture's start",
              0);
  EXPECT_TRUE(check("[-5:0], [0:0], [1:1], [1000:1], [1001:0]").empty());
}

TEST(FunctionCheck, PartsAfterTheCapture) {
  expect_only(check("[0:1], [999999999:1], [1000000001:0]"), Kind::after_capture,
              "after the capture's end at 1 s", 2);
  EXPECT_TRUE(check("[0:1], [999999999:1], [1000000000:0], [2000000000:0]").empty());
  // Without a capture nothing is known to lie after it.
  EXPECT_TRUE(check("[0:1], [999999999:1], [1000000001:0]", {2 * kSecond, false}).empty());
}

TEST(FunctionCheck, HeldGains) {
  expect_only(check("[400000000:0], [410000000:1]"), Kind::held_gain,
              "the last gain, 1, holds to the end of the capture at 1 s", 1);
  expect_only(check("[5:1], [10:0]"), Kind::held_gain, "the first gain, 1, holds from the start", 0);
  expect_only(check("[400000000:1], [410000000:1]"), Kind::held_gain, "and the last gain, 1, holds", 1);
  expect_only(check("[0:0], [410000000:1]", {410'000'000, false}), Kind::held_gain,
              "holds to the end of the capture;", 1);
  EXPECT_TRUE(check("[400000000:0], [410000000:1], [410000001:0]").empty());
  EXPECT_TRUE(check("[0:1], [10:0]").empty());          // held only before the capture
  EXPECT_TRUE(check("[0:0], [1000000000:1]").empty());  // and only after it
}

TEST(FunctionCheck, StillGainsThatAreNotPositive) {
  expect_only(check("[0:-1], [10:-1], [11:0]"), Kind::still_gain_not_positive, "the still gain is -0.9", {});
  expect_only(check("[0:0], [10:1], [20:0], [30:-1], [40:0]"), Kind::still_gain_not_positive,
              "the still gain is 0: its positive and negative parts cancel", {});
  EXPECT_TRUE(check("[0:0], [10:1], [20:0], [30:-0.9], [40:0]").empty());
}

TEST(FunctionCheck, StillGainsThatSaturate) {
  expect_only(check("[0:2], [10:2], [11:0]"), Kind::still_gain_saturates, "the still gain is 1.90909: ", {});
  expect_only(check("[0:0], [1:1.25], [1000000000:1.25]"), Kind::still_gain_saturates,
              "more than 80 % of white's light", {});
  // The trail of Figure 16: it climbs to 2, and its mean is 1.
  EXPECT_TRUE(check("[0:0], [600000000:0], [800000000:2], [800000001:0], [1000000000:0]").empty());
}

TEST(FunctionCheck, MistypedTimes) {
  const auto findings = check(
      "[0:0], [1:1], [100000000:1], [1000000002:-25], [1010000000:-25], [1010000001:0]", {3 * kSecond, true});
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].kind, Kind::still_gain_not_positive);
  expect_says(findings[0].message, "-10.84");
  EXPECT_EQ(findings[1].kind, Kind::mistyped_time);
  EXPECT_EQ(findings[1].point, 2u);
  EXPECT_EQ(
      findings[1].message,
      "time 100000000 probably has lost a digit: it is likely 1000000000, which makes the ramp from gain "
      "1 to -25 a step of 2 ns; now it takes 900 ms");
}

// Over 3 s, as the paper has it, nothing is suspicious about its functions, but for the lost zero.
TEST(FunctionCheck, TheFiguresAreSilent) {
  for (const char* name : {"figure04", "figure07", "figure14-restored", "figure16"}) {
    const std::string path = std::string(NUTIK_TEST_CORPUS) + "/" + name + ".fn";
    for (const CheckedDomain domain : {CheckedDomain{3 * kSecond, true}, CheckedDomain{3 * kSecond, false}}) {
      for (const auto& [tag, read] : parse_functions(read_file(path)).functions) {
        for (const FunctionFinding& finding :
             check_function(read.function, summarize(read.function, domain.duration_ns), domain)) {
          ADD_FAILURE() << name << " M" << int{tag} << ": " << finding.message;
        }
      }
    }
  }
}

TEST(FunctionCheck, StopsAreTheLogarithmOfTheStillGain) {
  const auto stops = [](double gain) {
    return still_stops(summarize(GainFunction::boxcar(0, 1000, gain), kSecond));
  };
  EXPECT_EQ(stops(1.0), 0.0);
  EXPECT_EQ(stops(4.0), 2.0);
  EXPECT_EQ(stops(0.5), -1.0);
  EXPECT_EQ(stops(-1.0), std::nullopt);
  EXPECT_EQ(stops(0.0), std::nullopt);
}

TEST(FunctionCheck, PlacesOfTimesAreThoseInTheText) {
  const std::string text = "\xEF\xBB\xBF# comment\r\nM0{[0:1], # one\r\n  [ +25 : 0 ]}\r\nM7 [3:0]\n";
  const SourceText source(text);
  const FunctionFile file = parse_functions(text);
  const FileFunction& first = file.functions.at(0);
  ASSERT_EQ(first.time_at.size(), 2u);
  EXPECT_EQ(source.place_of(first.start_at), (TextPlace{2, 1}));
  EXPECT_EQ(source.place_of(first.time_at[0]), (TextPlace{2, 5}));
  EXPECT_EQ(source.place_of(first.time_at[1]), (TextPlace{3, 5}));
  ASSERT_EQ(file.functions.at(7).time_at.size(), 1u);
  EXPECT_EQ(source.place_of(file.functions.at(7).time_at[0]), (TextPlace{4, 5}));
}

}  // namespace
}  // namespace nutik::test
