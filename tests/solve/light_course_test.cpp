// Integrals of a region's light times gains.
#include "solve/region_light.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <random>

namespace nutik {
namespace {

ChannelLight integral(const LightCourse& course, std::vector<GainPiece> pieces) {
  return course.integral_ns(pieces);
}

// Samples of 10 ns of which half is exposed: 1 holds for 5 ns, goes to 3 in 5 ns, holds, and holds across the last gap.
TEST(LightCourse, HoldsWhileExposedAndRunsStraightAcrossGaps) {
  const Timeline timeline = Timeline::constant({100'000'000, 1}, {180, 1}, 2);
  const LightCourse course(timeline, 0, {{1, 10, 0}, {3, 10, 0}});
  EXPECT_EQ(integral(course, {{0, 5, 1, 1}}), (ChannelLight{5, 50, 0}));
  EXPECT_EQ(integral(course, {{5, 10, 1, 1}}), (ChannelLight{10, 50, 0}));
  EXPECT_EQ(integral(course, {{0, 20, 2, 2}}), (ChannelLight{90, 400, 0}));
  // Gain and light rise together: ∫ (1 + 2 t) t for t in [0, 1], times 5 ns.
  EXPECT_NEAR(integral(course, {{5, 10, 0, 1}})[0], 5 * (0.5 + 2.0 / 3), 1e-12);
  EXPECT_EQ(integral(course, {{0, 5, 0, 0}, {15, 20, -1, -1}}), (ChannelLight{-15, -50, 0}));
}

// Long pieces are told from runs of samples; cut into short ones they are not.
TEST(LightCourse, OfAPieceIsTheSumOfItsParts) {
  std::mt19937 random(1);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  constexpr std::uint64_t kSamples = 400;
  const Timeline timeline = Timeline::constant({1000, 1}, {270, 1}, kSamples);
  std::vector<ChannelLight> light(kSamples);
  for (ChannelLight& each : light) each = {within(0, 1), within(0, 1), within(0, 1)};
  const LightCourse course(timeline, 0, light);
  for (int repetition = 0; repetition < 50; ++repetition) {
    const auto begin_ns = static_cast<std::int64_t>(within(0, 100e6)),
               end_ns = static_cast<std::int64_t>(within(250e6, 400e6));
    const GainPiece whole{begin_ns, end_ns, within(-2, 2), within(-2, 2)};
    std::vector<GainPiece> parts;
    for (std::int64_t at = begin_ns; at < end_ns; at += 1'500'000) {
      const std::int64_t until = std::min(at + 1'500'000, end_ns);
      parts.push_back({at, until, whole.at(at), whole.at(until)});
    }
    const ChannelLight expected = course.integral_ns(parts), found = integral(course, {whole});
    for (std::size_t channel = 0; channel < 3; ++channel) {
      // Some 400 products of up to 1 · 2 · 10^6 ns.
      ASSERT_NEAR(found[channel], expected[channel], 400 * 2e6 * 0x1p-48) << repetition;
    }
  }
}

// What a command adds up against --memory.
TEST(LightCourse, TakesNoMoreThanItSays) {
  constexpr std::uint64_t kSamples = 100'000;
  const Timeline timeline = Timeline::constant({1000, 1}, {360, 1}, kSamples);
  const auto taken = [] { return mallinfo2().uordblks + mallinfo2().hblkhd; };
  const std::size_t before = taken();
  const LightCourse course(timeline, 0, std::vector<ChannelLight>(kSamples));
  const std::size_t bytes = taken() - before;
  std::printf("%zu of %llu bytes\n", bytes, static_cast<unsigned long long>(LightCourse::bytes(kSamples)));
  EXPECT_LE(bytes, LightCourse::bytes(kSamples) + 3 * 8192) << "and what malloc rounds up";
}

}  // namespace
}  // namespace nutik
