// What plans have in common is made once, and a plan is the same whether its parts were kept or made.
#include "render/plan_cache.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "capture/error.hpp"
#include "render/error_bound.hpp"
#include "render/fixed_scale.hpp"
#include "support/packed_tables.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// A capture of 5 blocks, and 64 functions that each have a row of the picture.
struct Scene {
  Scene() {
    const Rasters rasters(50, std::vector<std::byte>(16 * 64, std::byte{90}));
    const CaptureFormat format{.shape = {16, 64, 1}};
    capture.emplace(format, Timeline::constant({100, 1}, Timeline::kFullShutter, 50), rasters, 10);
    mask = Mask::uniform(16, 64, 0);
    for (std::uint32_t y = 0; y < 64; ++y) {
      std::fill_n(mask.tags.begin() + y * 16, 16, static_cast<std::uint8_t>(y));
      functions.emplace(static_cast<std::uint8_t>(y), function_of(y, 200'000'000));
    }
  }

  static GainFunction function_of(std::uint32_t tag, std::int64_t time_ns) {
    return GainFunction({{0, 0.5}, {time_ns, 0.01 * tag}, {400'000'000, 1.0}});
  }

  std::optional<MemoryCapture> capture;
  Mask mask;
  FunctionSet functions;
};

void expect_same_numbers(const RenderPlan& plan, const RenderPlan& expected) {
  const auto found = packed_tables(plan), wanted = packed_tables(expected);
  EXPECT_EQ(found.weights, wanted.weights);
  EXPECT_EQ(found.boundaries, wanted.boundaries);
  const FixedScale scale = fixed_scale(plan);
  EXPECT_EQ(scale.exponents, fixed_scale(expected).exponents);
  EXPECT_EQ(fixed_tables(plan, scale).weights, fixed_tables(expected, scale).weights);
  for (const Precision precision : kPrecisions) {
    const ErrorBound a = error_bound(plan, precision, {ValueType::code8, 255});
    const ErrorBound b = error_bound(expected, precision, {ValueType::code8, 255});
    EXPECT_EQ(a.worst.light, b.worst.light);
    EXPECT_EQ(a.worst.steps, b.worst.steps);
  }
}

TEST(PlanCache, MakesTheTableThatChanged) {
  Scene scene;
  PlanCache cache;
  const auto plan = [&] { return cache.plan(*scene.capture, scene.functions, scene.mask, {}); };
  const RenderPlan first = plan();
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_THROW(measure_tables(first, stopped.get_token()), Cancelled);
  EXPECT_EQ(cache.statistics().tables_made, 0u);  // nobody has needed one yet
  measure_tables(first);
  EXPECT_EQ(cache.statistics().tables_made, 64u);
  EXPECT_EQ(cache.statistics().maps_made, 1u);

  scene.functions.at(7) = Scene::function_of(7, 230'000'000);
  const RenderPlan moved = plan();
  measure_tables(moved);
  EXPECT_EQ(cache.statistics().tables_made, 65u);
  EXPECT_EQ(cache.statistics().maps_made, 1u);
  for (std::size_t f = 0; f < 64; ++f) {
    EXPECT_EQ(moved.functions[f].table == first.functions[f].table, f != 7) << f;
  }
  expect_same_numbers(moved, make_plan(*scene.capture, scene.functions, scene.mask, {}));

  std::ranges::reverse(scene.mask.tags);
  const RenderPlan painted = plan();
  measure_tables(painted);
  EXPECT_EQ(cache.statistics().tables_made, 65u);
  EXPECT_EQ(cache.statistics().maps_made, 2u);
  EXPECT_EQ(painted.functions[7].table, moved.functions[7].table);
}

// A mask that leaves functions out needs no table of theirs, and makes none when they are back.
TEST(PlanCache, MakesNoTableForAnotherMask) {
  Scene scene;
  PlanCache cache;
  const auto made = [&](const Mask& mask) {
    measure_tables(cache.plan(*scene.capture, scene.functions, mask, {}));
    return cache.statistics().tables_made;
  };
  EXPECT_EQ(made(Mask::uniform(16, 64, 3)), 1u);
  EXPECT_EQ(made(scene.mask), 64u);
  EXPECT_EQ(made(Mask::uniform(16, 64, 5)), 64u);
  EXPECT_EQ(made(scene.mask), 64u);
}

TEST(PlanCache, TouchesOnlyTheBlocksOfAFunction) {
  Scene scene;
  PlanCache cache;
  const FunctionSet functions{{0, GainFunction::boxcar(210'000'000, 220'000'000)}};
  const RenderPlan plan = cache.plan(*scene.capture, functions, Mask::uniform(16, 64, 0), {});
  ASSERT_EQ(plan.blocks.size(), 1u);
  GainTable::Reader reader(*plan.functions[0].table);
  EXPECT_EQ(reader.block(2).weights.size(), 1u);
  EXPECT_TRUE(reader.block(1).weights.empty());
  EXPECT_TRUE(reader.block(4).boundaries.empty());
}

// With room for no table at all, each is made as often as it is read, and the same.
TEST(PlanCache, KeepsToItsBudget) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture = random.encode();
    PlanCache none(0);
    const RenderPlan plan = none.plan(capture, random.functions, random.mask, {});
    expect_same_numbers(plan, make_plan(capture, random.functions, random.mask, {}));
    EXPECT_EQ(none.statistics().table_bytes, 0u) << random.text();
    EXPECT_GE(none.statistics().tables_made, plan.blocks.empty() ? 0 : 1u) << random.text();
  }
}

// Runs of blocks end within a table: a long capture in little memory.
TEST(PlanCache, MakesLongTablesRunByRun) {
  constexpr std::uint64_t kSamples = 5 * CaptureLayout::kRunSamples / 2;
  const Rasters rasters(kSamples, std::vector<std::byte>(1, std::byte{9}));
  const MemoryCapture capture({.shape = {1, 1, 1}}, Timeline::constant({1000, 1}, {180, 1}, kSamples), rasters, 100);
  const FunctionSet functions{
      {0, GainFunction({{1'000'000'000, 0.0}, {9'000'000'000, 3.0}, {25'000'000'000, -1.0}})}};
  const Mask mask = Mask::uniform(1, 1, 0);
  PlanCache roomy, tight(CaptureLayout::kRunSamples * 20);
  const RenderPlan plan = tight.plan(capture, functions, mask, {});
  expect_same_numbers(plan, roomy.plan(capture, functions, mask, {}));
  EXPECT_EQ(roomy.statistics().tables_made, 3u);
  EXPECT_GT(tight.statistics().tables_made, 3u);
  EXPECT_GT(tight.statistics().table_bytes, 0u);
  EXPECT_LE(tight.statistics().table_bytes, CaptureLayout::kRunSamples * 20);
}

TEST(PlanCache, KnowsAnotherCapture) {
  PlanCache cache;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const RandomCase random(seed);
    for (const std::uint32_t block_samples : {3u, 64u}) {
      const MemoryCapture capture = random.encode(block_samples, TilePolicy::automatic);
      expect_same_numbers(cache.plan(capture, random.functions, random.mask, {}),
                          make_plan(capture, random.functions, random.mask, {}));
    }
  }
}

TEST(PlanCache, ManyThreadsMayAskAtATime) {
  Scene scene;
  PlanCache cache(20'000);
  const auto expected = packed_tables(make_plan(*scene.capture, scene.functions, scene.mask, {}));
  std::atomic<int> wrong{0};
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (std::uint32_t i = 0; i < 10; ++i) {
          FunctionSet functions = scene.functions;
          const std::uint8_t moved = static_cast<std::uint8_t>(thread * 10 + i);
          functions.at(moved) = Scene::function_of(moved, 100'000'000 + i);
          static_cast<void>(
              cache.plan(*scene.capture, functions, scene.mask, {}).functions[moved].table->course());
          const RenderPlan plan = cache.plan(*scene.capture, scene.functions, scene.mask, {});
          wrong += packed_tables(plan).weights != expected.weights;
        }
      });
    }
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace nutik::test
