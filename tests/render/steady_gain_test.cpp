// Steady gains, worked out by hand: blocks of 16 ms and 16 samples, no gaps.
#include "render/steady_gain.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "render/gain_table.hpp"

namespace nutik {
namespace {

constexpr std::int64_t kMsNs = 1'000'000;
constexpr std::uint64_t kBlocks = 40;
constexpr std::uint32_t kSamples = 16;

CaptureLayout layout(std::uint32_t samples = kSamples) {
  CaptureLayout made{Timeline::constant({1000, 1}, {360, 1}, kBlocks * samples), {}, {}, {0, kBlocks}};
  for (std::uint64_t block = 0; block < kBlocks; ++block) {
    made.blocks.push_back({block * samples, samples});
    const auto begin_ms = static_cast<std::int64_t>(block * samples);
    made.reaches.push_back({begin_ms * kMsNs, (begin_ms + samples) * kMsNs});
  }
  return made;
}

SteadyStretches stretches(const CaptureLayout& layout, const GainFunction& function) {
  const GainSummary summary = summarize(function, layout.timeline.duration_ns());
  return {function, summary, live_samples(summary, layout.timeline, false), layout};
}

SteadyStretches stretches(const CaptureLayout& layout, std::int64_t from_ms, std::int64_t to_ms) {
  return stretches(layout, GainFunction::boxcar(from_ms * kMsNs, to_ms * kMsNs));
}

TEST(SteadyGain, BundlesReachAnEndOfTheirGroup) {
  const CaptureLayout blocks = layout();
  const SteadyStretches steady = stretches(blocks, 20, 600);
  EXPECT_FALSE(steady.in(0, blocks).is_steady());
  for (const std::uint64_t block : {1, 2, 15}) {
    EXPECT_EQ(steady.in(block, blocks).bundle, (SummedBlocks{1, 15})) << block;
  }
  EXPECT_EQ(steady.in(16, blocks).bundle, (SummedBlocks{16, 16}));
  EXPECT_EQ(steady.in(36, blocks).bundle, (SummedBlocks{32, 5}));
  EXPECT_FALSE(steady.in(37, blocks).is_steady()) << "half of it is not more than half";
}

TEST(SteadyGain, ABlockThatIsCutNearItsEndIsCorrectedThere) {
  const CaptureLayout blocks = layout();
  const SteadyStretches steady = stretches(blocks, 20, 601);
  EXPECT_TRUE(steady.has_corrected());
  EXPECT_EQ(steady.in(1, blocks).corrected, (SampleSpan{0, 4}));
  EXPECT_TRUE(steady.in(2, blocks).corrected.empty());
  EXPECT_EQ(steady.in(37, blocks).corrected, (SampleSpan{9, 16}));
  EXPECT_EQ(steady.in(37, blocks).bundle, (SummedBlocks{32, 6}));
}

TEST(SteadyGain, AShortStretchHasNeitherBundlesNorCorrections) {
  const CaptureLayout blocks = layout();
  const SteadyStretches steady = stretches(blocks, 20, 100);
  EXPECT_FALSE(steady.has_corrected());
  EXPECT_FALSE(steady.in(1, blocks).is_steady());
  EXPECT_EQ(steady.in(2, blocks).bundle, (SummedBlocks{2, 1}));
  EXPECT_FALSE(steady.in(6, blocks).is_steady());
}

// Both together are the function's own weights.
TEST(SteadyGain, ACorrectionIsWhatTheSteadyGainHasTooMuch) {
  const CaptureLayout blocks = layout();
  const SteadyGain steady = stretches(blocks, 20, 601).in(1, blocks);
  const HatNumbers hats = hats_of(blocks.blocks[1], blocks.timeline);
  ASSERT_EQ(hats.weights, std::vector<double>(kSamples, 1e6));
  ASSERT_EQ(hats.boundaries.back(), 16e6);
  const std::vector<double> own(13, 0.25);  // of samples 3 … 15
  const CorrectionNumbers correction = correction_of(steady, hats, {3, 16}, own);
  const double each = -steady.per_ns * 1e6;
  EXPECT_EQ(correction.weights, (std::vector<double>{each, each, each, 0.25 + each}));
  EXPECT_DOUBLE_EQ(correction.boundaries.back(), 0.25 + 4 * each);
}

// A boxcar that begins and ends in blocks of 64 samples, so many ms behind their first one.
TEST(SteadyGain, OfALongCutBlockAThirdIsReadAtMost) {
  constexpr std::uint32_t kLong = 64;
  const CaptureLayout blocks = layout(kLong);
  struct Case {
    std::int64_t at_ms;
    std::optional<Halves> begin;
    SampleSpan begin_corrected;
    std::optional<Halves> end;
    SampleSpan end_corrected;
  };
  for (const Case& each : {Case{10, Halves::both, {0, 10}, {}, {}},
                           {20, Halves::both, {0, 20}, {}, {}},  // a half would save less than 8
                           {24, Halves::second, {24, 32}, Halves::first, {24, 32}},
                           {32, Halves::second, {32, 32}, Halves::first, {32, 32}},
                           {40, Halves::second, {32, 40}, Halves::first, {32, 40}},
                           {50, {}, {}, Halves::both, {50, 64}}}) {
    const SteadyStretches steady = stretches(blocks, kLong + each.at_ms, 30 * kLong + each.at_ms);
    const SteadyGain begin = steady.in(1, blocks), end = steady.in(30, blocks);
    EXPECT_EQ(begin.is_steady(), each.begin.has_value()) << each.at_ms;
    EXPECT_EQ(begin.bundle.halves, each.begin.value_or(Halves::both)) << each.at_ms;
    EXPECT_EQ(begin.corrected, each.begin_corrected) << each.at_ms;
    EXPECT_EQ(end.is_steady(), each.end.has_value()) << each.at_ms;
    EXPECT_EQ(end.bundle.halves, each.end.value_or(Halves::both)) << each.at_ms;
    EXPECT_EQ(end.corrected, each.end_corrected) << each.at_ms;
    const std::uint64_t first = each.begin == Halves::both ? 1 : 2;
    EXPECT_EQ(steady.in(2, blocks).bundle, (SummedBlocks{first, kGroupBlocks - first})) << each.at_ms;
    const std::uint64_t count = each.end == Halves::both ? 15 : 14;
    EXPECT_EQ(steady.in(29, blocks).bundle, (SummedBlocks{16, count})) << each.at_ms;
  }
}

// All samples of such a block are read in any case, or taken from a steady gain.
TEST(SteadyGain, ABlockBetweenTwoGainsHasNoHalves) {
  constexpr std::uint32_t kLong = 64;
  const CaptureLayout blocks = layout(kLong);
  const std::int64_t end_ns = blocks.timeline.duration_ns();
  for (const std::int64_t at_ms : {1, 20, 32, 40, 63}) {
    const std::int64_t step_ns = (20 * kLong + at_ms) * kMsNs;
    const GainFunction steps({{0, 1.0}, {step_ns, 1.0}, {step_ns, 2.0}, {end_ns, 2.0}});
    EXPECT_EQ(stretches(blocks, steps).in(20, blocks).bundle.halves, Halves::both) << at_ms;
  }
}

TEST(SteadyGain, SamplesBesideASteadyHalfAreCorrectedByTheirOwnWeights) {
  const CaptureLayout blocks = layout(64);
  const SteadyGain steady = stretches(blocks, 90, 2000).in(1, blocks);
  const HatNumbers hats = hats_of(blocks.blocks[1], blocks.timeline, Halves::second);
  EXPECT_EQ(hats.span, (SampleSpan{32, 64}));
  ASSERT_EQ(hats.weights, std::vector<double>(32, 1e6));
  ASSERT_EQ(hats.boundaries.back(), 32e6);
  const std::vector<double> own(38, 0.25);  // of samples 26 … 63
  const CorrectionNumbers correction = correction_of(steady, hats, {26, 64}, own);
  EXPECT_EQ(correction.weights, std::vector<double>(6, 0.25));

  const SteadyGain later = stretches(blocks, 104, 2000).in(1, blocks);
  const CorrectionNumbers less = correction_of(later, hats, {40, 64}, std::vector<double>(24, 0.25));
  EXPECT_EQ(less.weights, std::vector<double>(8, -later.per_ns * 1e6));
}

TEST(SteadyGain, SumsThatABlockMayBePartOfHaveNumbersOfTheirOwn) {
  std::set<std::uint32_t> numbers{(SummedBlocks{21, 1}).index()};
  EXPECT_EQ(numbers, std::set<std::uint32_t>{0});
  for (const Halves half : {Halves::first, Halves::second}) {
    numbers.insert((SummedBlocks{21, 1, half}).index());
  }
  for (std::uint64_t count = 2; count <= kGroupBlocks; ++count) {
    numbers.insert((SummedBlocks{kGroupBlocks, count}).index());
  }
  for (std::uint64_t at = 1; at + 2 <= kGroupBlocks; ++at) {
    numbers.insert((SummedBlocks{kGroupBlocks + at, kGroupBlocks - at}).index());
  }
  EXPECT_EQ(numbers.size(), 2 * kGroupBlocks);
  EXPECT_LT(*numbers.rbegin(), 32u) << "a bit for each";
}

}  // namespace
}  // namespace nutik
