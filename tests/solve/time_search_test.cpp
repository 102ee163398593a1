#include "solve/time_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/error.hpp"
#include "support/one_pixel.hpp"

namespace nutik::test {
namespace {

using Kind = LightWish::Kind;

TEST(TimeSearch, FindsAConstructedMoment) {
  // A ramp of light: a moment is told by its brightness.
  std::vector<double> light;
  for (int k = 0; k < 100; ++k) light.push_back(k < 60 ? 0.01 * k : 0.6 - 0.002 * (k - 60));
  OnePixel pixel(light);
  pixel.set("M0 [when-1:0], [when:1], [when+10000000:1], [when+10000001:0]");
  // From 123.4567 ms on for 10 ms: 6.5433 ms of sample 12, the rest of sample 13.
  const double wanted = (0.12 * 6.5433 + 0.13 * 3.4567) / 10;
  pixel.wish(Kind::equal, wanted);
  GainSearch search(pixel.wished);
  CandidateTimes every;
  every.step_ns = 10'000'000;
  for (std::int64_t k = 1; k <= 55; ++k) every.times_ns.push_back(k * every.step_ns);
  const auto found = find_times(search, {every});
  ASSERT_TRUE(found);
  EXPECT_NEAR(search.region_light()[0][0], wanted, 1e-8);
  // The steps at both ends count as 2 ns of support, which is 2e-7 of it: as much light as 25 ns of the ramp.
  EXPECT_NEAR(static_cast<double>(found->times_ns[0]), 123'456'700, 25);

  CandidateTimes stated = every;
  stated.step_ns = 0;
  const auto nearest = find_times(search, {stated});
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->times_ns[0], 120'000'000) << "candidates alone";
  EXPECT_EQ(nearest->tried, 55u);
}

TEST(TimeSearch, FindsTwoMomentsAndTheirGains) {
  std::vector<double> light;
  for (int k = 0; k < 100; ++k) light.push_back(0.5 + 0.4 * std::sin(0.07 * k) * std::exp(-0.01 * k));
  OnePixel pixel(light);
  pixel.set(
      "M0 [a-1:0], [a:g], [a+20000000:g], [a+20000001:0], [b-1:0], [b:h], [b+20000000:h], [b+20000001:0]");
  pixel.wished.bounds = {{0.0, 3.0}, {0.0, 3.0}};
  pixel.wish(Kind::at_least, 0.9);
  GainSearch search(pixel.wished);
  CandidateTimes early, late;
  early.step_ns = late.step_ns = 20'000'000;
  for (std::int64_t k = 1; k < 20; ++k) {
    early.times_ns.push_back(k * early.step_ns);
    late.times_ns.push_back(k * late.step_ns + 300'000'000);
  }
  const auto found = find_times(search, {early, late});
  ASSERT_TRUE(found);
  EXPECT_LE(found->found.cost, 1e-20);
  EXPECT_LT(found->times_ns[0] + 20'000'001, found->times_ns[1]);
}

TEST(TimeSearch, LeavesOutTimesWithWhichAFunctionCancels) {
  std::vector<double> light;
  for (int k = 0; k < 100; ++k) light.push_back(k < 30 ? 0.6 : 0.2);
  OnePixel pixel(light);
  pixel.set("M0 [0:1], [when:1], [when+1:-1]");
  pixel.wished.normalization = Normalization::parse("integral");
  // 0.6 · 0.3 + 0.2 · 0.4 - 0.2 · 0.3, over 0.4 s
  pixel.wish(Kind::equal, 0.5);
  GainSearch search(pixel.wished);
  CandidateTimes every;
  for (std::int64_t k = 1; k < 100; ++k) every.times_ns.push_back(k * 10'000'000);
  const auto found = find_times(search, {every});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->times_ns[0], 700'000'000);
  EXPECT_EQ(found->tried, 98u) << "all but 0.5 s";

  every.times_ns = {500'000'000};
  EXPECT_THROW(static_cast<void>(find_times(search, {every})), InputError);
}

TEST(TimeSearch, FindsTheEarliestOfSeveral) {
  // Bright at a candidate, and before between two.
  std::vector<double> light(100, 0.1);
  for (std::size_t k = 10; k < 20; ++k) light[k] = light[k + 50] = 0.8;
  OnePixel pixel(light);
  pixel.set("M0 [when-1:0], [when:1], [when+10000000:1], [when+10000001:0]");
  pixel.wish(Kind::at_least, 0.5);
  GainSearch search(pixel.wished);
  CandidateTimes few;
  few.step_ns = 200'000'000;
  few.times_ns = {50'000'000, 250'000'000, 450'000'000, 650'000'000};
  const auto found = find_times(search, {few});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->found.cost, 0.0);
  EXPECT_EQ(found->times_ns[0], 150'000'000);
}

TEST(TimeSearch, HasNoneWhereNoTimesAreInOrder) {
  OnePixel pixel({0.2, 0.2, 0.6});
  pixel.set("M0 [0:0], [when:1], [100:1], [101:0]");
  pixel.wish(Kind::equal, 0.5);
  GainSearch search(pixel.wished);
  CandidateTimes late;
  late.times_ns = {100, 200};
  EXPECT_FALSE(find_times(search, {late}));
}

}  // namespace
}  // namespace nutik::test
