#include "capture/timeline.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "capture/error.hpp"
#include "capture/made_samples.hpp"
#include "support/exact.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

TEST(Timeline, AConstantRateRoundsEachTimeFromItsOwnExactValue) {
  for (const Rational rate : {Rational{30, 1}, Rational{30000, 1001}, Rational{2997, 100}, Rational{960, 1},
                              Rational{999'999'937, 1'000'003}}) {
    for (const Rational angle : {Rational{360, 1}, Rational{180, 1}, Rational{1728, 10}}) {
      const std::uint64_t count = 1'000'000'000;
      const Timeline timeline = Timeline::constant(rate, angle, count);
      for (const std::uint64_t k : {0ull, 1ull, 2ull, 29ull, 1000ull, 86'399'999ull, 999'999'999ull}) {
        const cpp_rational period(cpp_int(rate.denominator) * 1'000'000'000, rate.numerator);
        const cpp_rational open(angle.numerator, angle.denominator * 360);
        EXPECT_EQ(timeline.start_ns(k), rounded_half_up(k * period)) << rate.text() << " " << k;
        EXPECT_EQ(timeline.end_ns(k), rounded_half_up((k + open) * period)) << rate.text() << " " << k;
      }
      EXPECT_EQ(
          timeline.duration_ns(),
          rounded_half_up(count * cpp_rational(cpp_int(rate.denominator) * 1'000'000'000, rate.numerator)));
    }
  }
}

TEST(Timeline, NeverDriftsOverADay) {
  const Timeline timeline = Timeline::constant({30000, 1001}, Timeline::kFullShutter, 30000ull * 86'400);
  // 30000 samples take 1001 s exactly.
  EXPECT_EQ(timeline.start_ns(30000ull * 86), 1001ll * 86 * 1'000'000'000);
  EXPECT_EQ(timeline.end_ns(0), 33'366'667);
}

TEST(Timeline, WithoutAShutterAngleThereAreNoGaps) {
  const Timeline timeline = Timeline::constant({30000, 1001}, Timeline::kFullShutter, 100);
  for (std::uint64_t k = 0; k + 1 < 100; ++k) EXPECT_EQ(timeline.end_ns(k), timeline.start_ns(k + 1));
  EXPECT_EQ(timeline.end_ns(99), timeline.duration_ns());
}

TEST(Timeline, IrregularStartsRepeatTheLastPeriod) {
  const Timeline timeline = Timeline::irregular({500, 1500, 1800}, {180, 1});
  EXPECT_EQ(timeline.start_ns(0), 0);
  EXPECT_EQ(timeline.end_ns(0), 500);
  EXPECT_EQ(timeline.start_ns(1), 1000);
  EXPECT_EQ(timeline.end_ns(1), 1150);
  EXPECT_EQ(timeline.start_ns(2), 1300);
  EXPECT_EQ(timeline.end_ns(2), 1450);
  EXPECT_EQ(timeline.duration_ns(), 1600);
}

TEST(Timeline, ExplicitExposuresEndWithTheLast) {
  const Timeline timeline = Timeline::explicit_exposures({{100, 200}, {250, 300}});
  EXPECT_EQ(timeline.start_ns(1), 150);
  EXPECT_EQ(timeline.end_ns(1), 200);
  EXPECT_EQ(timeline.duration_ns(), 200);
}

TEST(Timeline, SaysWhatIsWrongWithTimes) {
  expect_says(message_of<Error>([] {
                Timeline::irregular({0, 10, 10}, {360, 1});
              }),
              "sample 2 starts at 10 ns, not after sample 1 at 10 ns");
  expect_says(message_of<Error>([] {
                Timeline::explicit_exposures({{0, 10}, {5, 20}});
              }),
              "sample 1 starts at 5 ns, before sample 0 ends at 10 ns");
  expect_says(message_of<Error>([] { Timeline::explicit_exposures({{0, 0}}); }), "sample 0 ends at 0 ns");
  expect_says(message_of<Error>([] { Timeline::irregular({7}, {360, 1}); }), "state the rate");
  expect_says(message_of<Error>([] { Timeline::constant({0, 1}, {360, 1}, 1); }), "frame rate 0 is not positive");
  expect_says(message_of<Error>([] { Timeline::constant({30, 1}, {0, 1}, 1); }), "0 < angle <= 360");
  expect_says(message_of<Error>([] { Timeline::constant({30, 1}, {3601, 10}, 1); }), "360.1 is outside");
  expect_says(message_of<Error>([] { Timeline::constant({1'000'000'000, 1}, {1, 1}, 1); }), "less than 1 ns");
  expect_says(message_of<Error>([] { Timeline::constant({1, 1}, {360, 1}, 1ull << 62); }), "146 years");
}

// The samples found by bisection are those that a look at every sample finds.
TEST(Timeline, FindsTheSamplesThatReachAnInterval) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const Timeline timeline = random_timeline(random, static_cast<std::uint64_t>(random.whole(1, 40)));
    const std::int64_t duration = timeline.duration_ns();
    const std::int64_t begin = random.whole(-duration / 3, duration + duration / 3);
    const std::int64_t end = begin + random.whole(0, duration);
    const SampleRange found = timeline.samples_reaching(begin, end);
    for (std::uint64_t k = 0; k < timeline.sample_count(); ++k) {
      const SampleTimes times = timeline.times(k);
      const bool meets = std::max(times.before_ns, begin) < std::min(times.after_ns, end);
      EXPECT_EQ(meets, k >= found.first && k < found.last)
          << "seed " << seed << ", sample " << k << ", [" << begin << ", " << end << "]";
    }
  }
}

TEST(Timeline, TimesOfARangeAreThoseOfItsSamples) {
  const Timeline constant = Timeline::constant({30000, 1001}, {123, 1}, 9);
  const Timeline irregular = Timeline::irregular({0, 7, 12, 40, 41, 90}, {180, 1});
  for (const Timeline* timeline : {&constant, &irregular}) {
    const std::uint64_t count = timeline->sample_count();
    for (const SampleRange range :
         {SampleRange{0, count}, SampleRange{2, count - 1}, SampleRange{count - 1, count}}) {
      const std::vector<SampleTimes> times = timeline->times(range);
      ASSERT_EQ(times.size(), range.size());
      for (std::uint64_t i = 0; i < times.size(); ++i) {
        const SampleTimes one = timeline->times(range.first + i);
        EXPECT_EQ(times[i].before_ns, one.before_ns);
        EXPECT_EQ(times[i].start_ns, one.start_ns);
        EXPECT_EQ(times[i].end_ns, one.end_ns);
        EXPECT_EQ(times[i].after_ns, one.after_ns);
      }
    }
  }
  EXPECT_TRUE(constant.times(SampleRange{3, 3}).empty());
}

TEST(Timeline, TellsAMeanRateHoweverSlow) {
  for (const std::int64_t period_ns :
       {1ll, 7'000'000ll, 999'999'999ll, 1'000'000'000ll, 2'000'000'001'000ll, 3'600'000'000'000ll,
        86'400'000'000'000ll, 31'536'000'000'000'000ll, 1'000'000'000'000'000'000ll}) {
    const Timeline timeline = Timeline::irregular({0, period_ns, 2 * period_ns}, {180, 1});
    const double exact = 1e9 / static_cast<double>(period_ns);
    EXPECT_NEAR(timeline.rate().value(), exact, 0.0005 * exact) << period_ns;
    EXPECT_GT(timeline.rate().numerator, 0);
  }
  EXPECT_EQ(Timeline::irregular({0, 3'600'000'000'000}, {360, 1}).rate(), (Rational{1, 3600}));
  EXPECT_EQ(Timeline::stored({{0, 25'000'000}}, 100'000'000, {90, 1}).rate(), (Rational{10, 1}));
}

// 2^62 ns are documented. Beyond them differences of times leave 64 bits.
TEST(Timeline, RefusesTimesThatNoCaptureLasts) {
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max(),
                         kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLongest = std::int64_t{1} << 62;
  const auto refusal = [](auto make) { return message_of<InputError>([&] { return make(); }); };
  const std::string too_long = "longer than";
  for (const auto& starts : std::vector<std::vector<std::int64_t>>{{kMin, kMax},
                                                                   {kMin, 0, kMax},
                                                                   {0, kMax},
                                                                   {0, kLongest + 1},
                                                                   {0, kLongest},
                                                                   {kMax, kMin}}) {
    EXPECT_NE(refusal([&] {
                return Timeline::irregular(starts, {360, 1});
              }).find(too_long),
              std::string::npos)
        << starts[1];
  }
  for (const auto& exposures :
       std::vector<std::vector<Exposure>>{{{kMin, kMax}},
                                          {{0, kLongest + 1}},
                                          {{0, 1}, {kMax - 1, kMax}},
                                          {{kMax - 1, kMax}, {kMin, kMin + 1}}}) {
    expect_says(refusal([&] { return Timeline::explicit_exposures(exposures); }), too_long);
  }
  expect_says(refusal([&] { return Timeline::stored({{0, 1}}, kLongest + 1, {360, 1}); }), "146 years");
  EXPECT_EQ(Timeline::stored({{0, 1}}, kLongest, {360, 1}).duration_ns(), kLongest);
  EXPECT_EQ(Timeline::irregular({kMin, kMin + kLongest / 2}, {360, 1}).duration_ns(), kLongest);
}

// Whatever the shutter and the times are, what is left of a picture's exposure lies round its middle.
TEST(Timeline, OfMadeSamplesKnowsWhichArePictures) {
  const MadeSamples made{{3, 0, 1, 63, 2, 0}};
  for (const Rational angle : {Rational{360, 1}, Rational{180, 1}, Rational{1, 1}}) {
    for (const Timeline& filmed : {Timeline::constant({30'000, 1001}, angle, 6),
                                   Timeline::irregular({0, 1000, 1700, 20'000, 20'300, 90'000}, angle)}) {
      const Timeline all = made.times(filmed);
      EXPECT_EQ(all.pictures(), filmed);
      const std::vector<bool> is_made = made.marks();
      std::uint64_t picture = 0;
      for (std::uint64_t sample = 0; sample < all.sample_count(); ++sample) {
        const auto expected = is_made[sample] ? std::nullopt : std::optional(picture++);
        EXPECT_EQ(all.picture_of(sample), expected) << sample;
        if (expected) {
          EXPECT_EQ(all.sample_of(*expected), sample);
        }
      }
      EXPECT_EQ(filmed.sample_of(4), 4u);
      EXPECT_EQ(filmed.picture_of(4), 4u);
    }
  }
}

}  // namespace
}  // namespace nutik::test
