#include "exposure/weight_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/bounds.hpp"
#include "support/exact.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

TEST(WeightIntegrator, PacksWhatExactArithmeticSays) {
  double worst = 0.0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const auto count = static_cast<std::uint64_t>(random.whole(1, 30));
    const Timeline timeline = random_timeline(random, count);
    const GainFunction function = random_function(random, timeline);
    const GainSummary summary = summarize(function, timeline.duration_ns());
    if (summary.support_ns == 0) continue;
    const auto gain = exact_gain(function, timeline.duration_ns());
    const auto magnitudes = magnitude_of(gain);
    const Exact unit = Exact(std::scalbn(1.0, summary.exponent)) * summary.support_ns;

    WeightIntegrator integrator(function, summary, timeline.duration_ns());
    const std::vector<SampleTimes> times = timeline.times({0, count});
    std::vector<double> weights(count), boundaries(count + 1);
    integrator.pack(times, weights, boundaries);

    Exact boundary = 0, magnitude = 0;
    for (std::uint64_t k = 0; k < count; ++k) {
      const Exact exact = exact_weight_ns(gain, timeline, k);
      const Exact scale = exact_weight_ns(magnitudes, timeline, k);
      const double error = error_in(scale / unit, weights[k], exact / unit) / kRoundoff64;
      EXPECT_LE(error, kWeightRoundings) << "seed " << seed << ", sample " << k;
      worst = std::max(worst, error);
      boundary += exact;
      magnitude += scale;
      EXPECT_LE(error_in(magnitude / unit, boundaries[k + 1], boundary / unit) / kRoundoff64, kWeightRoundings + 1)
          << "seed " << seed << ", boundary " << k + 1;
    }
    EXPECT_EQ(boundaries[0], 0.0);
  }
  std::printf("worst error of a weight: %.2f u of its own ∫ ĝ φ\n", worst);
}

// Blocks may be packed in any order, and weights do not depend on where a block starts.
TEST(WeightIntegrator, DoesNotDependOnTheOrderOfBlocks) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const std::uint64_t count = 60;
    const Timeline timeline = random_timeline(random, count);
    const GainFunction function = random_function(random, timeline);
    const GainSummary summary = summarize(function, timeline.duration_ns());
    std::vector<double> whole(count), boundaries(count + 1), part(20), part_boundaries(21);
    WeightIntegrator(function, summary, timeline.duration_ns())
        .pack(timeline.times({0, count}), whole, boundaries);
    WeightIntegrator integrator(function, summary, timeline.duration_ns());
    for (const std::uint64_t first : {40ull, 0ull, 20ull}) {
      integrator.pack(timeline.times({first, first + 20}), part, part_boundaries);
      for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(part[i], whole[first + i]) << "seed " << seed;
      EXPECT_EQ(part_boundaries[0], 0.0);
    }
  }
}

}  // namespace
}  // namespace nutik::test
