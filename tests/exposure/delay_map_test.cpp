// Time maps: the delays that directions and pictures give, and what a function comes to wherever they put it.
#include "exposure/delay_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "exposure/gain_function.hpp"
#include "support/exact.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// The message of the error, if it holds `part`; else what it is instead.
template <typename Error, typename Act>
testing::AssertionResult refuses(Act act, const std::string& part) {
  const std::string message = message_of<Error>(act);
  if (message.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << message << "' does not say '" << part << "'";
}

constexpr std::int64_t kMs = 1'000'000;

std::vector<std::int64_t> delays_of(const DelayMap& map) {
  std::vector<std::int64_t> delays;
  for (std::uint64_t pixel = 0; pixel < map.delay_of_pixel.size(); ++pixel)
    delays.push_back(map.delay_ns(pixel));
  return delays;
}

template <typename Value>
Picture picture_of(ValueType type, std::uint32_t white, const std::vector<Value>& values) {
  Picture picture({static_cast<std::uint32_t>(values.size()), 1, 1}, type, white);
  std::memcpy(picture.bytes.data(), values.data(), picture.bytes.size());
  return picture;
}

TEST(DelayMap, RowsGoFromTheFirstToTheLast) {
  const DelayMap map = DelayMap::by_rows({2, 4, 3}, {0, 15 * kMs});
  EXPECT_EQ(delays_of(map),
            (std::vector<std::int64_t>{0, 0, 5 * kMs, 5 * kMs, 10 * kMs, 10 * kMs, 15 * kMs, 15 * kMs}));
}

TEST(DelayMap, ColumnsMayGoBackInTime) {
  const DelayMap map = DelayMap::by_columns({3, 2, 1}, {kMs, -kMs});
  EXPECT_EQ(delays_of(map), (std::vector<std::int64_t>{kMs, 0, -kMs, kMs, 0, -kMs}));
  EXPECT_EQ(map.delays_ns, (std::vector<std::int64_t>{-kMs, 0, kMs})) << "in increasing order";
}

TEST(DelayMap, EachDelayIsRoundedHalfUpFromItsOwnExactValue) {
  const DelayMap map = DelayMap::by_columns({5, 1, 1}, {-1, 1});
  EXPECT_EQ(delays_of(map), (std::vector<std::int64_t>{-1, 0, 0, 1, 1}));
  EXPECT_EQ(map.delays_ns, (std::vector<std::int64_t>{-1, 0, 1})) << "equal delays are one";
}

TEST(DelayMap, ASingleRowHasTheFirstDelay) {
  EXPECT_EQ(delays_of(DelayMap::by_rows({2, 1, 1}, {7, 9})), (std::vector<std::int64_t>{7, 7}));
}

TEST(DelayMap, TheRadiusIsTheCornersDistanceFromTheCentre) {
  const DelayMap map = DelayMap::by_radius({5, 3, 1}, {0, 1'000'000'000});
  EXPECT_EQ(map.delay_ns(7), 0) << "the centre";
  for (const std::uint64_t corner : {0, 4, 10, 14}) EXPECT_EQ(map.delay_ns(corner), 1'000'000'000);
  const double step = 1e9 / DelayMap::kRadialSteps;
  EXPECT_NEAR(static_cast<double>(map.delay_ns(8)), 1e9 / std::hypot(2.0, 1.0), step);
  EXPECT_EQ(DelayMap::by_radius({1, 1, 1}, {3, 9}).delay_ns(0), 3);
}

TEST(DelayMap, PicturesGoFromBlackToWhite) {
  const DelayRange range{0, 65'535};
  EXPECT_EQ(delays_of(DelayMap::by_picture(picture_of<std::uint8_t>(ValueType::code8, 255, {0, 1, 255}),
                                           range, "a")),
            (std::vector<std::int64_t>{0, 257, 65'535}));
  EXPECT_EQ(delays_of(DelayMap::by_picture(
                picture_of<std::uint16_t>(ValueType::code16, 65'535, {0, 1, 65'535}), range, "a")),
            (std::vector<std::int64_t>{0, 1, 65'535}));
  EXPECT_EQ(delays_of(DelayMap::by_picture(picture_of<float>(ValueType::light32, 0, {0.0f, 0.5f, 1.0f}),
                                           range, "a")),
            (std::vector<std::int64_t>{0, 32'768, 65'535}));
}

TEST(DelayMap, AllCodesOf16BitsAreDelays) {
  std::vector<std::uint16_t> codes(65'536);
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<std::uint16_t>(i);
  const DelayMap map =
      DelayMap::by_picture(picture_of(ValueType::code16, 65'535, codes), {0, 1'000'000'000}, "a");
  EXPECT_EQ(map.delays_ns.size(), DelayMap::kMaxDelays);
  EXPECT_EQ(map.delay_ns(65'535), 1'000'000'000);
}

TEST(DelayMap, WhatIsNoMapIsRefused) {
  EXPECT_TRUE(refuses<InputError>(
      [] {
        return DelayMap::by_picture(Picture({1, 1, 3}, ValueType::code8, 255), {0, 1}, "map.png");
      },
      "map.png is a colour picture"));
  for (const float light : {-0.5f, 1.5f, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_TRUE(refuses<InputError>(
        [&] {
          return DelayMap::by_picture(picture_of<float>(ValueType::light32, 0, {0.0f, light}), {0, 1}, "map.exr");
        },
        "map.exr: pixel 1,0 is "));
  }
  EXPECT_TRUE(refuses<UsageError>(
      [] {
        return DelayMap::by_rows({1, 65'537, 1}, {0, 1});
      },
      "the picture has 65537 rows"));
}

TEST(WholeCourse, IsTheFunctionItselfIfItLiesWithinTheCapture) {
  const GainFunction boxcar = GainFunction::boxcar(10 * kMs, 30 * kMs);
  const GainSummary course = summarize_course(boxcar, 100 * kMs), domain = summarize(boxcar, 100 * kMs);
  EXPECT_EQ(course.support_ns, domain.support_ns);
  EXPECT_EQ(course.integral_ns, domain.integral_ns);
  EXPECT_EQ(course.live, domain.live);
}

TEST(WholeCourse, CountsWhatLiesOutside) {
  const GainSummary course = summarize_course(GainFunction::boxcar(-10 * kMs, 30 * kMs), 20 * kMs);
  EXPECT_EQ(course.support_ns, 40 * kMs);
  EXPECT_EQ(course.live, (Interval{-10 * kMs, 30 * kMs}));
  EXPECT_FALSE(course.reaches_before_capture || course.reaches_after_capture);
}

// A function may be written with points beyond the capture that hold it within.
TEST(WholeCourse, CountsHeldEndsInTheCaptureAlone) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const auto course = [](std::vector<ControlPoint> points) {
    return summarize_course(GainFunction(std::move(points)), kSecond);
  };
  for (const std::int64_t time_ns : {4 * kSecond, -4 * kSecond, kSecond, std::int64_t{0}}) {
    EXPECT_EQ(course({{time_ns, 1.0}}).support_ns, kSecond) << time_ns;
    EXPECT_EQ(course({{time_ns, 1.0}}).still_gain(), 1.0) << time_ns;
  }
  // A jump there, and points behind it: 1 s held and 2 s between the points.
  EXPECT_EQ(course({{4 * kSecond, 1.0}, {4 * kSecond, 0.5}, {6 * kSecond, 0.5}}).support_ns, 3 * kSecond);
  EXPECT_EQ(course({{-6 * kSecond, 0.5}, {-4 * kSecond, 0.5}, {-4 * kSecond, 1.0}}).integral_ns, 1e9 + 1e9);
}

TEST(WholeCourse, IsExactOnRandomFunctions) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Timeline timeline = random_timeline(random, 20);
    const GainFunction function =
        random_function(random, timeline).shifted(random.whole(-1, 1) * 3 * timeline.duration_ns());
    EXPECT_EQ(summarize_course(function, timeline.duration_ns()).support_ns,
              exact_course_support_ns(function, timeline.duration_ns()));
  }
}

}  // namespace
}  // namespace nutik::test
