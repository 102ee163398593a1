// Time maps in plan and reference: each pixel's function comes later by its own delay.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "capture/error.hpp"
#include "render/delayed_pairs.hpp"
#include "render/plan_cache.hpp"
#include "render/reference_renderer.hpp"
#include "render/trace.hpp"
#include "support/bounds.hpp"
#include "support/delays.hpp"
#include "support/exact_exposure.hpp"
#include "support/messages.hpp"
#include "support/seeds.hpp"
#include "support/soft_mask.hpp"

namespace nutik::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// Every other case holds ends. NUTIK_TEST_CASES=10000 is the full run.
TEST(DelayedReference, StaysWithinAFewUlpOfExactArithmetic) {
  std::vector<double> shares;  // of the bound, each case's largest
  const Seeds seeds = test::seeds(0, 60);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    RandomCase random(seed);
    random.capture.noise.tolerance = 0;  // held codes are the source's
    Random draw(seed * 31 + 7);
    if (seed % 2 == 0) hold_ends(draw, random.functions, random.timeline.duration_ns());
    if (draw.chance(0.3)) soften(random.mask, random.functions, seed);
    MemoryCapture capture = random.encode();
    PlanOptions options;
    options.delays = random_delays(draw, random.capture.shape, random.timeline.duration_ns());
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, options);
    const Picture picture = ReferenceRenderer().render(plan, capture, kLight).picture;
    constexpr double kRoundings = kReferenceRoundings + 3;
    shares.push_back(worst_roundings(plan, random, picture, seed, kRoundings) / kRoundings);
    if (HasFailure()) return;
  }
  print_shares("reference, delays", shares);
}

// 8 samples at 100 a second, codes 10 k of 255 in each of 4 rows, linear.
class DelayedRows : public testing::Test {
 protected:
  static CaptureFormat format() { return {.shape = {1, 4, 1}, .transfer = Transfer::linear()}; }
  static Rasters rasters() {
    Rasters rasters;
    for (int k = 0; k < 8; ++k) rasters.emplace_back(4, static_cast<std::byte>(10 * k));
    return rasters;
  }

  RenderPlan plan(const GainFunction& function, const DelayRange& range) {
    return make_plan(capture_, {{0, function}}, Mask::uniform(1, 4, 0),
                     delayed_by(DelayMap::by_rows(format().shape, range)));
  }
  std::vector<double> codes(const GainFunction& function, const DelayRange& range) {
    const Picture light = ReferenceRenderer().render(plan(function, range), capture_, kLight).picture;
    std::vector<double> codes;
    for (const double value : light.values<double>()) codes.push_back(value * 255);
    return codes;
  }

  MemoryCapture capture_{format(), Timeline::constant({100, 1}, Timeline::kFullShutter, 8), rasters(), 3};
};

void expect_codes(const std::vector<double>& codes, const std::vector<double>& wanted) {
  ASSERT_EQ(codes.size(), wanted.size());
  for (std::size_t i = 0; i < codes.size(); ++i) EXPECT_NEAR(codes[i], wanted[i], 1e-12) << "row " << i;
}

TEST_F(DelayedRows, SweepThroughTheCapture) {
  expect_codes(codes(GainFunction::boxcar(0, 10 * kMs), {10 * kMs, 70 * kMs}), {10, 30, 50, 70});
  expect_codes(codes(GainFunction::boxcar(70 * kMs, 80 * kMs), {0, -60 * kMs}), {70, 50, 30, 10});
  expect_codes(codes(GainFunction::boxcar(0, 10 * kMs), {5 * kMs, 65 * kMs}), {5, 25, 45, 65});
}

TEST_F(DelayedRows, KeepTheirDWhereTheyLeaveTheCapture) {
  // The last row's boxcar lies half outside: half the light; a fourth row's wholly.
  expect_codes(codes(GainFunction::boxcar(0, 20 * kMs), {40 * kMs, 70 * kMs}), {45, 55, 65, 35});
  expect_codes(codes(GainFunction::boxcar(0, 10 * kMs), {50 * kMs, 80 * kMs}), {50, 60, 70, 0});
  // D counts what lies before the capture where there is no delay.
  expect_codes(codes(GainFunction::boxcar(-10 * kMs, 10 * kMs), {0, 30 * kMs}), {0, 5, 15, 25});
}

TEST_F(DelayedRows, AreWarnedOfWithNumbersOfPixels) {
  const RenderPlan out = plan(GainFunction::boxcar(0, 20 * kMs), {50 * kMs, 80 * kMs});
  ASSERT_EQ(out.warnings.size(), 2u);
  EXPECT_EQ(out.warnings[0],
            "M0: for 1 of 4 pixels the delay moves the whole function outside of the capture (0 … 0.08 s); "
            "they are 0");
  EXPECT_EQ(out.warnings[1],
            "M0: for 1 of 4 pixels the delay moves a part of the function behind the capture's end at 0.08 s; "
            "nothing is "
            "added there, though D counts it, so they are darker");
  EXPECT_TRUE(plan(GainFunction::boxcar(0, 10 * kMs), {0, 70 * kMs}).warnings.empty());
  const RenderPlan held = plan(GainFunction({{10 * kMs, 0.0}, {10 * kMs, 1.0}}), {0, 30 * kMs});
  ASSERT_EQ(held.warnings.size(), 1u);
  expect_says(held.warnings[0], "its last gain is not 0");
}

TEST_F(DelayedRows, AreWarnedOfOnceWhereItHoldsOfSeveralFunctions) {
  const GainFunction held({{10 * kMs, 0.0}, {10 * kMs, 1.0}});
  Mask mask = Mask::uniform(1, 4, 0);
  mask.tags = {0, 1, 0, 1};
  const RenderPlan both =
      make_plan(capture_, {{0, held}, {1, held}}, mask, delayed_by(DelayMap::by_rows(format().shape, {0, 30 * kMs})));
  ASSERT_EQ(both.warnings.size(), 1u);
  EXPECT_TRUE(both.warnings[0].starts_with("M0, M1: its last gain is not 0")) << both.warnings[0];
}

TEST_F(DelayedRows, AreTracedTogetherWithTheirDelay) {
  const RenderPlan swept = plan(GainFunction::boxcar(0, 10 * kMs), {10 * kMs, 70 * kMs});
  const auto traces = trace_pixel(swept, capture_, 0, 2);
  ASSERT_EQ(traces.size(), 1u);
  EXPECT_NEAR(traces[0].light[0] * 255, 50, 1e-12);
  EXPECT_EQ(swept.functions[traces[0].function].delay_ns, 50 * kMs);
  EXPECT_THROW(static_cast<void>(trace_region(swept, capture_, 0)), UsageError);
}

TEST_F(DelayedRows, NeedTheSamplesOfAllDelays) {
  const PlanOptions options = delayed_by(DelayMap::by_rows(format().shape, {20 * kMs, 50 * kMs}));
  const SampleRange needed = needed_samples(capture_.timeline(), {{0, GainFunction::boxcar(0, 10 * kMs)}},
                                            Mask::uniform(1, 4, 0), options);
  EXPECT_EQ(needed, (SampleRange{2, 6}));
}

TEST_F(DelayedRows, AreRefusedWhereTheirMapHasAnotherSize) {
  expect_error<InputError>(
      [&] {
        return make_plan(capture_, {{0, GainFunction({{0, 1.0}})}}, Mask::uniform(1, 4, 0),
                         delayed_by(DelayMap::by_rows({2, 4, 1}, {0, 1})));
      },
      {"the map of delays is 2 x 4 pixels and the pictures are 1 x 4"});
}

TEST(DelayedPlan, TellsRegionsByMaskValueAndDelay) {
  const CaptureFormat format{.shape = {4, 2, 1}};
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, 1),
                        Rasters(1, std::vector<std::byte>(8)), 64);
  Mask mask = Mask::uniform(4, 2, 3);
  mask.tags[7] = 9;
  mask.mixed.add(7, std::array<Share, 2>{{{3, 20'000}, {9, 45'535}}});
  const FunctionSet functions{{3, GainFunction({{0, 1.0}})}, {9, GainFunction({{0, 0.5}})}};
  const PlanOptions options = delayed_by(DelayMap::by_columns(format.shape, {0, 3}));
  PlanCache cache;
  const RenderPlan plan = cache.plan(capture, functions, mask, options);
  ASSERT_EQ(plan.function_count(), 5u) << "four delays of M3, and the one that M9 has";
  EXPECT_EQ(plan.function_of(0), 0u);
  EXPECT_EQ(plan.function_of(7), 4u);
  EXPECT_EQ(plan.functions[3].pixel_count, 2u);
  EXPECT_EQ(plan.functions[4].delay_ns, 3);
  ASSERT_EQ(plan.shares_of(7).size(), 2u);
  EXPECT_EQ(plan.shares_of(7)[0], (Share{3, 20'000}));
  EXPECT_EQ(plan.shares_of(7)[1], (Share{4, 45'535}));

  const PlanOptions equal = delayed_by(DelayMap::by_columns(format.shape, {0, 3}));
  EXPECT_EQ(cache.plan(capture, functions, mask, equal).map, plan.map) << "equal maps are one";
  EXPECT_NE(cache.plan(capture, functions, mask, delayed_by(DelayMap::by_columns(format.shape, {0, 4}))).map, plan.map);
  EXPECT_NE(cache.plan(capture, functions, mask, {}).map, plan.map);
}

// Against a map of pairs, with delays that fill words of 64 bits, fall short of one or begin another.
TEST(DelayedPlan, NumbersPairsByMaskValueThenDelay) {
  const Seeds seeds = test::seeds(0, 40);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE(rerun(seed));
    Random random(seed);
    const auto width = static_cast<std::uint32_t>(random.whole(1, 90));
    const auto height = static_cast<std::uint32_t>(random.whole(1, 9));
    Mask mask = Mask::uniform(width, height, 0);
    DelayMap delays{width, height, {}, {}};
    const std::int64_t count = random.pick(std::vector<std::int64_t>{1, 63, 64, 65, 700});
    for (std::int64_t delay = 0; delay < count; ++delay) delays.delays_ns.push_back(3 * delay - 100);
    std::map<std::pair<int, int>, std::uint64_t> expected;
    for (std::uint64_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
      mask.tags[pixel] = random.pick(std::vector<std::uint8_t>{0, 9, 255});
      delays.delay_of_pixel.push_back(static_cast<std::uint16_t>(random.whole(0, count - 1)));
      ++expected[{mask.tags[pixel], delays.delay_of_pixel[pixel]}];
      if (mask.tags[pixel] != 9 || random.chance(0.5)) continue;
      mask.mixed.add(pixel, std::array<Share, 2>{{{9, 45'535}, {254, 20'000}}});
      ++expected[{254, delays.delay_of_pixel[pixel]}];
    }
    const DelayedPairs pairs(mask, delays);
    const auto map = MaskMap::of(mask, std::make_shared<const DelayMap>(delays));
    ASSERT_EQ(pairs.count(), expected.size());
    ASSERT_EQ(map->regions.size(), expected.size());
    std::size_t number = 0;
    for (const auto& [pair, pixels] : expected) {
      EXPECT_EQ(pairs.number_of(static_cast<std::uint8_t>(pair.first), static_cast<std::uint16_t>(pair.second)),
                number);
      const MaskRegion& region = map->regions[number++];
      EXPECT_EQ(region.tag, pair.first);
      EXPECT_EQ(region.delay_ns, 3 * pair.second - 100);
      EXPECT_EQ(region.pixel_count, pixels);
    }
  }
}

}  // namespace
}  // namespace nutik::test
