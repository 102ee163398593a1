// Error bounds and scales of whole numbers, from tables alone.
#include "render/error_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/fixed_scale.hpp"
#include "render/renderer.hpp"
#include "support/packed_tables.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

TEST(ErrorBound, ShrinksWithBetterArithmetic) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const ErrorBound single = error_bound(plan, Precision::single_, kLight);
    const ErrorBound fixed = error_bound(plan, Precision::fixed, kLight);
    const ErrorBound compensated = error_bound(plan, Precision::compensated, kLight);
    const ErrorBound real64 = error_bound(plan, Precision::double_, kLight);
    for (std::size_t f = 0; f < plan.functions.size(); ++f) {
      if (plan.functions[f].summary.support_ns == 0) {
        EXPECT_EQ(single.functions[f].light, 0.0) << random.text();
        continue;
      }
      EXPECT_LT(fixed.functions[f].light, single.functions[f].light) << random.text();
      EXPECT_LT(compensated.functions[f].light, single.functions[f].light) << random.text();
      EXPECT_LT(real64.functions[f].light, compensated.functions[f].light) << random.text();
      EXPECT_LE(single.functions[f].light, single.worst.light);
    }
  }
}

// 12.92 and 4.5 codes of error for each of light at the dark end; all of it where light may be anything.
TEST(ErrorBound, CodesErrMostInTheDark) {
  EXPECT_NEAR(code_error(Transfer::srgb(), 255, {1e-6, 0.0}), 255 * 12.92e-6, 1e-12);
  EXPECT_NEAR(code_error(Transfer::bt709(), 65'535, {1e-6, 0.0}), 65'535 * 4.5e-6, 1e-9);
  EXPECT_NEAR(code_error(Transfer::linear(), 4095, {1e-3, 0.0}), 4.095, 1e-9);
  EXPECT_NEAR(code_error(Transfer::gamma(2.0), 255, {1e-4, 0.0}), 2.55, 1e-9);
  EXPECT_NEAR(code_error(Transfer::gamma(0.5), 255, {1e-4, 0.0}), 255 * (1 - 0.9999 * 0.9999), 1e-9);
  EXPECT_EQ(code_error(Transfer::srgb(), 255, {2.0, 0.0}), 255);
  EXPECT_EQ(code_error(Transfer::srgb(), 255, {NAN, 0.0}), 255);
  EXPECT_NEAR(code_error(Transfer::srgb(), 255, {0.0, 0.0}), 0.0, 1e-12);
}

const std::vector<Transfer> kEveryTransfer{Transfer::srgb(), Transfer::bt709(), Transfer::linear(),
                                           Transfer::gamma(2.2), Transfer::gamma(0.6), Transfer::hlg(), Transfer::pq()};

// The largest L · f′(L): by these much codes err where light errs by a share of itself.
TEST(ErrorBound, CodesOfErrorsInProportionToLightCostNoMoreInTheDark) {
  constexpr double kShare = 1e-6;
  const std::vector<double> slopes{0.43958, 0.49468, 1.0, 1 / 2.2, 1 / 0.6, 0.25, 0.10912};
  for (std::size_t i = 0; i < kEveryTransfer.size(); ++i) {
    const double error = code_error(kEveryTransfer[i], 65'535, {1e-60, kShare}) / (65'535 * kShare);
    EXPECT_GE(error, slopes[i] * (1 - 1e-4)) << kEveryTransfer[i].text();
    EXPECT_LE(error, slopes[i] * 1.012) << kEveryTransfer[i].text();
  }
}

// Against many lights, each off to both sides by all that it may be.
TEST(ErrorBound, CodesErrByNoMoreThanIsFoundForAnyLight) {
  Random random(3);
  for (const Transfer& transfer : kEveryTransfer) {
    for (int i = 0; i < 200; ++i) {
      const LightLine line{std::exp(random.real(-30, -3)), std::exp(random.real(-16, -3))};
      double largest = 0.0;
      for (int k = 0; k <= 2000; ++k) {
        const double light = k < 1000 ? std::exp2(-k / 20.0) : (k - 1000) / 1000.0;
        const double error = line.constant + line.slope * light;
        for (const double other : {light + error, light - error}) {
          largest = std::max(largest, std::fabs(transfer.fraction_of(std::clamp(other, 0.0, 1.0)) -
                                                transfer.fraction_of(light)));
        }
      }
      const double bound = code_error(transfer, 1, line);
      ASSERT_GE(bound, largest * (1 - 1e-9)) << transfer.text() << ": " << line.constant << ", " << line.slope;
      ASSERT_LE(bound, std::min(1.0, largest * 1.25)) << transfer.text() << ": " << line.constant << ", " << line.slope;
    }
  }
  EXPECT_EQ(code_error(Transfer::srgb(), 255, {1e-9, 1.0}), 255);
  EXPECT_EQ(code_error(Transfer::srgb(), 255, {1e-9, NAN}), 255);
}

// Whatever the sizes of gains: no sum of light and weights leaves 62 bits, and none stays far below.
TEST(FixedScale, FillsTheSumsAndNeverOverflows) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomCase random(seed);
    Random sizes(seed);
    for (auto& [tag, function] : random.functions) {
      std::vector<ControlPoint> points(function.points().begin(), function.points().end());
      for (ControlPoint& point : points)
        point.gain = std::scalbn(point.gain, static_cast<int>(sizes.whole(-900, 900)));
      function = GainFunction(std::move(points));
    }
    const MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const FixedScale scale = fixed_scale(plan);
    const auto tables = fixed_tables(plan, scale);
    const auto exact_tables = packed_tables(plan);
    for (std::size_t f = 0; f < plan.functions.size(); ++f) {
      long double magnitude = 0, exact = 0;
      for (std::size_t at = f; at < tables.weights.size(); at += plan.function_count()) {
        magnitude += std::abs(tables.weights[at]);
        exact += std::fabs(exact_tables.weights[at]);
      }
      const long double largest = magnitude * static_cast<long double>(scale.white_light);
      ASSERT_LE(largest, 0x1p62L) << random.text();
      if (exact > 0) {
        ASSERT_GE(largest, 0x1p59L) << random.text();
      }
    }
  }
}

TEST(FixedScale, TablesAreTheSameInAnyParts) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode(3, TilePolicy::automatic);
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const FixedScale scale = fixed_scale(plan);
    const auto whole = fixed_tables(plan, scale);
    ASSERT_EQ(whole.weights.size(), plan.row_count() * plan.function_count());
    PackedTables<std::int64_t> joined;
    for (std::size_t last = 0, step = 0; last < plan.blocks.size(); ++step) {
      const std::size_t first = last;
      last = std::min(plan.blocks.size(), last + step % 3);
      const auto part = fixed_tables(plan, scale, first, last);
      joined.weights.insert(joined.weights.end(), part.weights.begin(), part.weights.end());
      joined.boundaries.insert(joined.boundaries.end(), part.boundaries.begin(), part.boundaries.end());
    }
    ASSERT_EQ(joined.weights, whole.weights) << random.text();
    ASSERT_EQ(joined.boundaries, whole.boundaries) << random.text();
  }
}

// Weights come from boundaries that are rounded once for the whole capture.
TEST(FixedScale, TablesDoNotDependOnBlocks) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RandomCase random(seed);
    std::vector<std::vector<std::int64_t>> weights_by_function;
    for (const std::uint32_t block_samples : {1u, 7u, 64u, 1000u}) {
      const MemoryCapture capture = random.encode(block_samples, TilePolicy::dense);
      const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
      const auto tables = fixed_tables(plan, fixed_scale(plan));
      std::vector<std::vector<std::int64_t>> weights(plan.function_count());
      for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
        const PlannedBlock& block = plan.blocks[b];
        for (std::size_t f = 0; f < plan.function_count(); ++f) {
          for (std::uint32_t k = 0; k < block.extent.sample_count; ++k) {
            const std::uint64_t at = (block.table_row + k) * plan.function_count() + f;
            ASSERT_EQ(tables.weights[at],
                      tables.boundaries[at + plan.function_count()] - tables.boundaries[at]);
            if (tables.weights[at] != 0) weights[f].push_back(tables.weights[at]);
          }
          ASSERT_EQ(tables.boundaries[block.table_row * plan.function_count() + f], 0);
        }
      }
      if (weights_by_function.empty()) weights_by_function = weights;
      ASSERT_EQ(weights, weights_by_function) << random.text() << ", here in blocks of " << block_samples;
    }
  }
}

TEST(PrecisionChoice, TakesTheFirstThatIsRightEnoughElseTheBest) {
  const Rasters rasters(100, std::vector<std::byte>(1, std::byte{90}));
  const MemoryCapture capture({.shape = {1, 1, 1}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100), rasters,
                              64);
  const auto choose = [&](double gain, const OutputFormat& output, std::vector<Precision> available) {
    const GainFunction function({{640'000'000, gain}, {640'000'000, 2 - gain}});
    return choose_precision(make_plan(capture, {{0, function}}, Mask::uniform(1, 1, 0), {}), output,
                            available);
  };
  const std::vector<Precision> all{Precision::single_, Precision::double_, Precision::fixed,
                                   Precision::compensated};
  const std::vector<Precision> without_double{Precision::single_, Precision::fixed, Precision::compensated};
  const OutputFormat codes{ValueType::code8, 255};
  EXPECT_EQ(choose(1.0, codes, all).precision(), Precision::single_);
  EXPECT_TRUE(choose(1.0, codes, all).rejected.empty());
  EXPECT_EQ(choose(1e4, codes, all).precision(), Precision::double_);
  EXPECT_EQ(choose(1e4, codes, without_double).precision(), Precision::fixed);
  EXPECT_EQ(choose(1e7, codes, without_double).precision(), Precision::compensated);
  EXPECT_EQ(choose(1.0, {ValueType::light32, 0}, all).precision(), Precision::double_);
  EXPECT_EQ(choose(1.0, kLight, all).precision(), Precision::double_);
  const PrecisionChoice none = choose(1e18, codes, all);
  EXPECT_EQ(none.precision(), Precision::double_);
  EXPECT_FALSE(none.is_right_enough());
  EXPECT_EQ(none.rejected.size(), 3u);
}

// Where every arithmetic may be wrong by all codes there are, light still tells them apart.
TEST(PrecisionChoice, TakesTheLeastInLightWhereAllCodesMayBeWrong) {
  const Rasters rasters(100, std::vector<std::byte>(1, std::byte{90}));
  const MemoryCapture capture({.shape = {1, 1, 1}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100), rasters,
                              64);
  for (const double gain : {1e20, 1e100, 1e300}) {
    const GainFunction function({{640'000'000, gain}, {640'000'000, 2 - gain}});
    const RenderPlan plan = make_plan(capture, {{0, function}}, Mask::uniform(1, 1, 0), {});
    const std::vector<Precision> available{Precision::single_, Precision::fixed, Precision::compensated};
    const PrecisionChoice choice = choose_precision(plan, {ValueType::code8, 255}, available);
    EXPECT_EQ(choice.precision(), Precision::compensated) << gain;
    EXPECT_EQ(choice.bound.worst.steps, 255) << gain;
    ASSERT_EQ(choice.rejected.size(), 2u) << gain;
    for (const ErrorBound& rejected : choice.rejected) {
      EXPECT_EQ(rejected.worst.steps, 255) << gain;
      EXPECT_LT(choice.bound.worst.light, rejected.worst.light) << gain;
    }
  }
}

TEST(PrecisionChoice, SaysWhatItMayErrBy) {
  EXPECT_EQ(error_text({3.1e-7, 0.0102}, {ValueType::code8, 255}),
            "light within 3.1e-07, 0.01 of an 8-bit code");
  EXPECT_EQ(error_text({3.4e-3, 34.12}, {ValueType::code8, 255}), "light within 0.0034, 34.1 8-bit codes");
  EXPECT_EQ(error_text({3.1e-7, 0.2625}, {ValueType::code16, 4095}),
            "light within 3.1e-07, 0.26 of a 12-bit code");
  EXPECT_EQ(error_text({3.1e-7, 0.2625}, {ValueType::code16, 1000}),
            "light within 3.1e-07, 0.26 of a code of 1000");
  EXPECT_EQ(error_text({1e-8, 0.17}, {ValueType::light32, 0}), "light within 1e-08, 0.17 of a float's step");
  EXPECT_EQ(error_text({1e-13, 0.1}, kLight), "light within 1e-13");
}

}  // namespace
}  // namespace nutik::test
