// Time maps on the device: every arithmetic within its bound, and equal to what needs none.
#include <gtest/gtest.h>

#include "capture/format.hpp"
#include "render/reference_renderer.hpp"
#include "support/delays.hpp"
#include "support/precision_check.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"
#include "support/soft_mask.hpp"

namespace nutik::test {
namespace {

// Every third mask is soft, every other function holds its ends beyond the capture.
void check_random_case(PrecisionCheck& check, std::uint64_t seed) {
  RandomCase random(seed);
  Random draw(seed * 31 + 7);
  if (seed % 2 == 0) hold_ends(draw, random.functions, random.timeline.duration_ns());
  if (draw.chance(0.33)) soften(random.mask, random.functions, seed);
  MemoryCapture capture = random.encode();
  PlanOptions options;
  options.live_all = draw.chance(0.1);
  options.delays = random_delays(draw, random.capture.shape, random.timeline.duration_ns());
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, options);
  check.check(plan, capture, format("Delays{}", seed), rerun(seed));
  if (testing::Test::HasFailure()) FAIL() << random.text() << ", " << options.delays->delays_ns.size() << " delays";
}

// NUTIK_TEST_CASES=10000 is the full run (docs/explanation/accuracy.md).
TEST(Delays, StayWithinTheirBoundsOnRandomCases) {
  PrecisionCheck check;
  const Seeds seeds = test::seeds(0, 60);
  for (std::uint64_t seed = seeds.first; seed < seeds.last && !HasFatalFailure(); ++seed)
    check_random_case(check, seed);
  check.print();
}

// Pixels of one function in a tile whose others are shared with one of a far larger gain: fixed made their codes of
// light in 12 bits.
TEST(Delays, LeaveAPixelOfOneFunctionAsExactAsItIsAlone) {
  PrecisionCheck check;
  check_random_case(check, 2447);
}

// 40 x 264 pixels, 60 samples at 100 a second, tiles of all kinds.
struct DelayScene {
  DelayScene() {
    format.shape = {40, 264, 3};
    Random random(5);
    rasters = random_rasters(random, format, 60);
  }
  [[nodiscard]] MemoryCapture capture() const { return {format, timeline, rasters, 16}; }
  [[nodiscard]] Mask mask() const { return Mask::uniform(40, 264, 0); }

  CaptureFormat format;
  Timeline timeline = Timeline::constant({100, 1}, {270, 1}, 60);
  Rasters rasters;
};

GainFunction triangle(std::int64_t begin_ns, std::int64_t end_ns) {
  return GainFunction({{begin_ns, 0.0}, {(begin_ns + end_ns) / 2, 1.5}, {end_ns, 0.0}});
}

// It is the same function in the same place, in tables of the same kind: not only within the bound.
TEST(Delays, OfOneLengthAreAMovedFunctionToTheLastBit) {
  const DelayScene scene;
  MemoryCapture capture = scene.capture();
  for (const std::int64_t delay_ns : {-37'123'456, 0, 123'456'789}) {
    const GainFunction function = triangle(100'000'000, 190'000'001);
    const RenderPlan moved = make_plan(capture, {{0, function.shifted(delay_ns)}}, scene.mask(), {});
    const RenderPlan delayed = make_plan(capture, {{0, function}}, scene.mask(),
                                         delayed_by(DelayMap::by_rows(scene.format.shape, {delay_ns, delay_ns})));
    ReferenceRenderer reference;
    EXPECT_EQ(reference.render(delayed, capture, kLight).picture.bytes,
              reference.render(moved, capture, kLight).picture.bytes);
    for (const Precision precision : first_precisions()) {
      OpenClRenderer renderer(renderer_options(precision));
      EXPECT_EQ(renderer.render(delayed, capture, kLight).picture.bytes,
                renderer.render(moved, capture, kLight).picture.bytes)
          << to_text(precision) << ", " << delay_ns << " ns";
    }
  }
}

// 256 strips of a row each, whose functions expose whole samples, are what a map of 256 steps makes without a mask.
TEST(Delays, Of256StepsAreARecipeOf256Strips) {
  DelayScene scene;
  scene.format.shape.height = 256;
  for (auto& raster : scene.rasters) raster.resize(scene.format.sample_bytes());
  scene.timeline = Timeline::constant({100, 1}, Timeline::kFullShutter, 60);
  MemoryCapture capture = scene.capture();
  Mask strips = Mask::uniform(40, 256, 0);
  FunctionSet functions;
  Picture steps({40, 256, 1}, ValueType::code8, 255);
  const auto start_ns = [](std::uint32_t row) { return std::int64_t{row} * 10'000'000 / 5; };
  for (std::uint32_t row = 0; row < 256; ++row) {
    functions.emplace(static_cast<std::uint8_t>(row),
                      GainFunction::boxcar(start_ns(row), start_ns(row) + 40'000'000));
    for (std::uint32_t x = 0; x < 40; ++x) {
      strips.tags[std::size_t{row} * 40 + x] = static_cast<std::uint8_t>(row);
      steps.values<std::uint8_t>()[std::size_t{row} * 40 + x] = static_cast<std::uint8_t>(row);
    }
  }
  const RenderPlan recipe = make_plan(capture, functions, strips, {});
  const RenderPlan map = make_plan(capture, {{0, GainFunction::boxcar(0, 40'000'000)}}, Mask::uniform(40, 256, 0),
                                   delayed_by(DelayMap::by_picture(steps, {0, start_ns(255)}, "steps")));
  EXPECT_TRUE(map.warnings.empty());
  for (const Precision precision : first_precisions()) {
    OpenClRenderer renderer(renderer_options(precision));
    for (const OutputFormat& output : {kLight, OutputFormat{ValueType::code8, 255}}) {
      EXPECT_EQ(renderer.render(map, capture, output).picture.bytes,
                renderer.render(recipe, capture, output).picture.bytes)
          << to_text(precision);
    }
  }
}

// More functions than a byte counts, exposed again and again from what stays on the device.
TEST(Delays, GiveTheSamePictureFromAResidentCapture) {
  const DelayScene scene;
  MemoryCapture capture = scene.capture();
  OpenClRenderer resident(renderer_options(Precision::single_));
  resident.keep_resident(&capture);
  for (const std::int64_t start_ns : {0, 10'000'000, 10'000'000, 250'000'000}) {
    const RenderPlan plan =
        make_plan(capture, {{0, GainFunction::boxcar(start_ns, start_ns + 200'000'000)}}, scene.mask(),
                  delayed_by(DelayMap::by_rows(scene.format.shape, {0, 100'000'000})));
    ASSERT_EQ(plan.function_count(), 264u);
    OpenClRenderer fresh(renderer_options(Precision::single_));
    EXPECT_EQ(resident.render(plan, capture, kLight).picture.bytes,
              fresh.render(plan, capture, kLight).picture.bytes);
  }
}

TEST(Delays, AreTestedByTheRenderersOwnTest) {
  const DelayScene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, {{0, triangle(0, 90'000'000)}}, scene.mask(),
                                    delayed_by(DelayMap::by_rows(scene.format.shape, {0, 100'000'000})));
  for (const Precision precision : first_precisions()) {
    OpenClOptions options = renderer_options(precision);
    options.tests_itself = true;
    options.cache_folder.clear();
    EXPECT_TRUE(OpenClRenderer(options).render(plan, capture, kLight).passed_self_test) << to_text(precision);
  }
}

}  // namespace
}  // namespace nutik::test
