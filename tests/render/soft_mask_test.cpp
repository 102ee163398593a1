// Soft masks in plan, reference and bound.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render/error_bound.hpp"
#include "render/plan_cache.hpp"
#include "render/reference_renderer.hpp"
#include "support/bounds.hpp"
#include "support/exact_exposure.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"
#include "support/soft_mask.hpp"

namespace nutik::test {
namespace {

TEST(SoftMask, TheReferenceStaysWithinItsBoundOfExactArithmetic) {
  // What blending adds: a product, their sum, the division.
  constexpr double kRoundings = kReferenceRoundings + 3;
  double worst = 0.0;
  const Seeds seeds = test::seeds(0, 60);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    RandomCase random(seed);
    random.capture.noise.tolerance = 0;
    soften(random.mask, random.functions, seed);
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const Picture picture = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
    worst = std::max(worst, worst_roundings(plan, random, picture, seed, kRoundings));
  }
  std::printf("worst error of the reference: %.2f u of Σ α ∫|g|/D\n", worst);
}

// By hand: light 3/5, twice as bright in one function and negative in the other.
TEST(SoftMask, LightIsMixedByShares) {
  const CaptureFormat format{{2, 1, 1}, 1, 5, Transfer::linear(), {}};
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, 1),
                        Rasters{{std::byte{3}, std::byte{3}}}, 1);
  Mask mask = Mask::uniform(2, 1, 1);
  mask.mixed.add(1, std::array<Share, 2>{{{1, 13'107 * 4}, {7, 13'107}}});  // four fifths and one
  const FunctionSet functions{{1, GainFunction({{0, 2.0}})}, {7, GainFunction({{0, -1.0}})}};
  const RenderPlan plan = make_plan(capture, functions, mask, {});
  const Picture light = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
  EXPECT_DOUBLE_EQ(light.values<double>()[0], 2 * 0.6);
  EXPECT_NEAR(light.values<double>()[1], 0.8 * 2 * 0.6 - 0.2 * 0.6, 1e-15);
  // Rectangles, and memory for few rows at a time, change no bit.
  for (std::uint32_t x = 0; x < 2; ++x) {
    EXPECT_EQ(ReferenceRenderer()
                  .render(plan, capture, {ValueType::light64, 0},
                          {.rectangle = Rectangle{x, 0, 1, 1}, .memory_bytes = 1 << 20})
                  .picture.values<double>()[0],
              light.values<double>()[x]);
  }
}

TEST(SoftMask, APlanHasTheFunctionsThatOnlySharesUse) {
  const CaptureFormat format{{20, 9, 1}, 1, 255, Transfer::linear(), {}};
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, 1),
                        Rasters{std::vector<std::byte>(180)}, 1);
  Mask mask = Mask::uniform(20, 9, 0);
  mask.mixed.add(9, std::array<Share, 2>{{{0, 60'000}, {200, 5'535}}});
  FunctionSet functions{{0, GainFunction({{0, 1.0}})}};
  EXPECT_THROW(static_cast<void>(make_plan(capture, functions, mask, {})), InputError);
  functions.emplace(200, GainFunction({{0, 1.0}}));
  PlanCache cache;
  const RenderPlan plan = cache.plan(capture, functions, mask, {});
  ASSERT_EQ(plan.functions.size(), 2u);
  EXPECT_EQ(plan.functions[0].pixel_count, 180u);
  EXPECT_EQ(plan.functions[1].pixel_count, 1u);
  ASSERT_EQ(plan.map->mixed_tiles.size(), 1u);
  EXPECT_EQ(plan.map->mixed_tiles[0].tile, 1u);
  EXPECT_EQ(plan.map->mixed_tiles[0].tags, (std::vector<std::uint8_t>{0, 200}));

  EXPECT_EQ(cache.plan(capture, functions, mask, {}).map, plan.map) << "the same mask has the same map";
  Mask other = Mask::uniform(20, 9, 0);
  EXPECT_NE(cache.plan(capture, functions, other, {}).map, plan.map);
  other.mixed.add(9, std::array<Share, 2>{{{0, 60'001}, {200, 5'534}}});
  EXPECT_NE(cache.plan(capture, functions, other, {}).map, plan.map);
}

TEST(SoftMask, SharesAddUpOrAreRefused) {
  MixedPixels mixed;
  EXPECT_THROW(mixed.add(0, std::array<Share, 1>{{{0, 65'535}}}), std::logic_error);
  EXPECT_THROW(mixed.add(0, std::array<Share, 2>{{{0, 65'534}, {1, 2}}}), std::logic_error);
  EXPECT_THROW(mixed.add(0, std::array<Share, 2>{{{0, 65'535}, {1, 0}}}), std::logic_error);
  EXPECT_THROW(mixed.add(0, std::array<Share, 2>{{{2, 65'534}, {1, 1}}}), std::logic_error);
  mixed.add(3, std::array<Share, 2>{{{1, 65'534}, {2, 1}}});
  EXPECT_THROW(mixed.add(3, std::array<Share, 2>{{{1, 65'534}, {2, 1}}}), std::logic_error);
  EXPECT_TRUE(mixed.of(2).empty());
  EXPECT_EQ(mixed.of(3)[0], (Share{1, 65'534}));
  Mask mask{3, 1, {0, 0, 0}, mixed};
  EXPECT_EQ(message_of<InputError>([&] { return regions_of(mask); }),
            "pixel 3 shares value 2, and the mask has 3 pixels and values up to 255");
  mask.mixed = {};
  mask.mixed.add(2, std::array<Share, 2>{{{1, 65'534}, {256, 1}}});
  EXPECT_THROW(static_cast<void>(regions_of(mask)), InputError);
}

// What no mixture passes: the bound of the whole plan.
TEST(SoftMask, TheBoundOfAPlanIsNoLessThanThatOfAnyPixel) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomCase random(seed);
    soften(random.mask, random.functions, seed);
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    for (const Precision precision : kPrecisions) {
      for (const ValueType type :
           {ValueType::code8, ValueType::code16, ValueType::light32, ValueType::light64}) {
        const ErrorBound bound = error_bound(plan, precision, {type, 255});
        const PixelErrors errors(plan, bound);
        for (std::uint64_t pixel = 0; pixel < random.mask.tags.size(); ++pixel) {
          const PictureError error = errors.of(pixel);
          ASSERT_LE(error.light, bound.worst.light) << random.text();
          ASSERT_LE(error.steps, bound.worst.steps * (1 + 0x1p-40)) << random.text();
          double of_functions = 0.0;
          for (const Share& share : plan.shares_of(pixel)) {
            of_functions += share.size / 65'535.0 * bound.functions[share.of].light;
          }
          ASSERT_GE(error.light, of_functions);
        }
      }
    }
  }
}

}  // namespace
}  // namespace nutik::test
