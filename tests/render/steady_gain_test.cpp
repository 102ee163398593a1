// Steady gains, worked out by hand: blocks of 16 ms and 16 samples, no gaps.
#include "render/steady_gain.hpp"

#include <gtest/gtest.h>

#include <set>

namespace nutik {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint64_t kBlocks = 40;
constexpr std::uint32_t kSamples = 16;

CaptureLayout layout() {
  CaptureLayout made{Timeline::constant({1000, 1}, {360, 1}, kBlocks * kSamples), {}, {}, {0, kBlocks}};
  for (std::uint64_t block = 0; block < kBlocks; ++block) {
    made.blocks.push_back({block * kSamples, kSamples});
    const auto begin_ms = static_cast<std::int64_t>(block * kSamples);
    made.reaches.push_back({begin_ms * kMs, (begin_ms + kSamples) * kMs});
  }
  return made;
}

SteadyStretches stretches(const CaptureLayout& layout, std::int64_t from_ms, std::int64_t to_ms) {
  const GainFunction boxcar = GainFunction::boxcar(from_ms * kMs, to_ms * kMs);
  return {boxcar, summarize(boxcar, layout.timeline.duration_ns()), layout};
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

TEST(SteadyGain, BundlesOfAGroupHaveNumbersOfTheirOwn) {
  std::set<std::uint32_t> numbers{(SummedBlocks{21, 1}).index()};
  EXPECT_EQ(numbers, std::set<std::uint32_t>{0});
  for (std::uint64_t count = 2; count <= kGroupBlocks; ++count) {
    numbers.insert((SummedBlocks{kGroupBlocks, count}).index());
  }
  for (std::uint64_t at = 1; at + 2 <= kGroupBlocks; ++at) {
    numbers.insert((SummedBlocks{kGroupBlocks + at, kGroupBlocks - at}).index());
  }
  EXPECT_EQ(numbers.size(), 2 * kGroupBlocks - 2);
  EXPECT_LT(*numbers.rbegin(), 31u) << "a bit beside the one for kept sums";
}

}  // namespace
}  // namespace nutik
