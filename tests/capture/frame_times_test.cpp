// Frames are exposed when exact fractions say, however long the video is.
#include "capture/frame_times.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/exact.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

constexpr ExactTime kFromTheStart{};
constexpr Rational kLifeSpeed{1, 1};

cpp_rational exact(Rational value) { return {value.numerator, value.denominator}; }

TEST(FrameTimes, NeverDriftOverAnHourOfThirtyThousandByAThousandAndOne) {
  const FrameTimes frames(kFromTheStart, {30000, 1001}, kLifeSpeed, {180, 1});
  const cpp_rational period(cpp_int(1001) * 1'000'000'000, 30000);
  const std::uint64_t hour = frames.count_starting_by(3'600'000'000'000);
  ASSERT_EQ(hour, 107'893u);  // ⌊3600 · 30000 / 1001⌋ + 1
  for (std::uint64_t k = 0; k < hour; ++k) {
    ASSERT_EQ(frames.start_ns(k), rounded_half_up(k * period)) << k;
    ASSERT_EQ(frames.end_ns(k), rounded_half_up((k + cpp_rational(1, 2)) * period)) << k;
  }
  // Every 30000th frame starts on a whole multiple of 1001 s.
  EXPECT_EQ(frames.start_ns(90'000), 3'003'000'000'000);
}

TEST(FrameTimes, ACapturesOwnRateAndAngleGiveItsOwnExposures) {
  for (const Rational rate : {Rational{30000, 1001}, Rational{2997, 100}, Rational{960, 1}, Rational{7, 3}}) {
    for (const Rational angle : {Rational{360, 1}, Rational{180, 1}, Rational{1728, 10}}) {
      const std::uint64_t count = 5000;
      const Timeline timeline = Timeline::constant(rate, angle, count);
      for (const std::uint64_t first : {0ull, 1ull, 1234ull}) {
        const FrameTimes frames(ExactTime::of_sample(timeline, first), rate, kLifeSpeed, angle);
        for (std::uint64_t k = first; k < count; ++k) {
          ASSERT_EQ(frames.exposure(k - first), (Exposure{timeline.start_ns(k), timeline.end_ns(k)}))
              << rate.text() << " " << angle.text() << " " << first << " " << k;
        }
        EXPECT_EQ(frames.count_ending_by(timeline.duration_ns()), count - first) << rate.text();
      }
    }
  }
}

// A third and a quarter are seven twelfths; what has a longer denominator than 10^15 is the nearest that has not.
TEST(ExactTimes, AddUpInLowestTerms) {
  const auto sum = [](ExactTime a, ExactTime b) {
    const ExactTime found = a + b;
    return cpp_rational(cpp_int(static_cast<std::int64_t>(found.numerator)),
                        cpp_int(static_cast<std::int64_t>(found.denominator)));
  };
  EXPECT_EQ(sum({1, 3}, {1, 4}), cpp_rational(7, 12));
  EXPECT_EQ(sum({-5, 6}, {22, 6}), cpp_rational(17, 6));
  EXPECT_EQ((ExactTime{1, 6} + ExactTime{1, 3}).denominator, 2);
  EXPECT_EQ(sum({7, 1}, {-9, 1}), -2);
  const ExactTime fine = ExactTime{1, 999'999'937} + ExactTime{1, 999'999'893};
  EXPECT_EQ(fine.denominator, 1'000'000'000'000'000);
  EXPECT_EQ(fine.numerator, 2'000'000);
}

TEST(FrameTimes, AreExactForAnyRateSpeedAngleAndStart) {
  Random random(20);
  for (int i = 0; i < 3000; ++i) {
    const auto whole = [&](std::int64_t low, std::int64_t high) { return random.whole(low, high); };
    const Rational rate = Rational::of(whole(1, 30'000), whole(1, 1001));
    const Rational speed = Rational::of(whole(1, 100), whole(1, 100));
    const Rational angle = Rational::of(whole(1, 2'000'000), whole(1, 1000));
    const ExactTime from{whole(-1'000'000'000'000, 1'000'000'000'000), whole(1, 1'000'000'000)};
    const auto k = static_cast<std::uint64_t>(whole(0, 10'000'000));
    const FrameTimes frames(from, rate, speed, angle);
    const cpp_rational period = exact(speed) / exact(rate) * 1'000'000'000;
    const cpp_rational start =
        cpp_rational(static_cast<std::int64_t>(from.numerator), static_cast<std::int64_t>(from.denominator)) +
        k * period;
    ASSERT_EQ(frames.start_ns(k), rounded_half_up(start)) << i;
    ASSERT_EQ(frames.end_ns(k), rounded_half_up(start + exact(angle) / 360 * period)) << i;
    ASSERT_LT(frames.start_ns(k), frames.end_ns(k)) << i;
    // Frames are counted up to and with the one that ends just then.
    EXPECT_EQ(frames.count_ending_by(frames.end_ns(k)), k + 1) << i;
    EXPECT_EQ(frames.count_ending_by(frames.end_ns(0) - 1), 0u) << i;
    EXPECT_EQ(frames.count_starting_by(frames.start_ns(k)), k + 1) << i;
    EXPECT_EQ(frames.count_starting_by(frames.start_ns(k) - 1), k) << i;
  }
}

TEST(FrameTimes, StayExactAtTheLimitsOfWhatCanBeWritten) {
  const ExactTime from{(static_cast<int128>(1) << 61) * 999'999'999'999'999 + 7, 999'999'999'999'999};
  const Rational rate{999'999'937, 999'999'929};
  const Rational angle{999'999'937, 999'983};
  const FrameTimes frames(from, rate, kLifeSpeed, angle);
  const std::uint64_t k = 1'000'000'007;
  const cpp_rational start =
      cpp_rational(cpp_int(1) << 61) + cpp_rational(7, 999'999'999'999'999) + k / exact(rate) * 1'000'000'000;
  EXPECT_EQ(frames.start_ns(k), rounded_half_up(start));
  EXPECT_EQ(frames.end_ns(k), rounded_half_up(start + exact(angle) / 360 / exact(rate) * 1'000'000'000));
}

TEST(ExactTime, IsRoundedOnceWhenItIsAdded) {
  // A third and a fraction that each round down, and up together.
  EXPECT_EQ(rounded_sum({10, 3}, {10, 3}), 7);
  EXPECT_EQ(rounded_sum({-1, 2}, {0, 1}), 0);
  Random random(9);
  for (int i = 0; i < 3000; ++i) {
    const auto time = [&] {
      return ExactTime{random.whole(-4'000'000'000'000'000'000, 4'000'000'000'000'000'000),
                       random.whole(1, 1'000'000'000'000'000)};
    };
    const ExactTime a = time(), b = time();
    const auto exactly = [](const ExactTime& t) {
      return cpp_rational(static_cast<std::int64_t>(t.numerator), static_cast<std::int64_t>(t.denominator));
    };
    ASSERT_EQ(rounded_sum(a, b), rounded_half_up(exactly(a) + exactly(b))) << i;
  }
}

TEST(FrameTimes, RefuseWhatMakesNoSense) {
  const auto expect_refused = [](Rational rate, Rational speed, Rational angle, const std::string& part) {
    expect_error<UsageError>([&] { return FrameTimes(kFromTheStart, rate, speed, angle); }, {part});
  };
  expect_refused({0, 1}, {1, 1}, {180, 1}, "frame rate 0 is not positive");
  expect_refused({24, 1}, {-1, 4}, {180, 1}, "speed -0.25 is not positive");
  expect_refused({24, 1}, {1, 1}, {0, 1}, "shutter angle 0 is not positive");
  expect_refused({1'000'000'000'1, 1}, {1, 1}, {180, 1}, "more than nine digits");
  expect_refused({999'999'937, 1}, {1, 999'983}, {180, 1}, "more digits than times stay exact with");
  expect_refused({1'000'000'000, 1}, {1, 1}, {359, 1}, "less than 1 ns");
  expect_refused({1, 1'000'000'000}, {1, 1}, {720, 1}, "longer than 31 years");
}

}  // namespace
}  // namespace nutik::test
