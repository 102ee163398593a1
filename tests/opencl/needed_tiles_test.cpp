// Groups of tiles that an exposure does not read are not unpacked, and no picture shows it.
#include <gtest/gtest.h>

#include "opencl/opencl_renderer.hpp"
#include "support/packed_capture.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

// Functions that need some samples only, for some of the mask's values.
FunctionSet short_functions(const FunctionSet& functions, const Timeline& timeline, Random& draw) {
  FunctionSet chosen;
  for (const auto& [tag, function] : functions) {
    if (draw.chance(0.4)) continue;
    const std::int64_t begin = draw.whole(0, timeline.duration_ns() - 1);
    chosen.emplace(tag, GainFunction::boxcar(begin, draw.whole(begin + 1, timeline.duration_ns())));
  }
  return chosen;
}

TEST(NeededTiles, LeaveThePictureAsItIs) {
  std::uint64_t left_out = 0, unpacked = 0;
  const auto available = first_precisions();
  OpenClRenderer plain(renderer_options({})), passing(renderer_options({})), holding(renderer_options({}));
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    Random draw(seed);
    MemoryCapture capture = random.encode();
    PackedCapture packed(capture, static_cast<std::uint64_t>(draw.whole(1, 5)));
    holding.keep_resident(&packed);
    const Shape& shape = random.capture.shape;
    // One after another, so that what is held of one exposure is too little for the next.
    for (int turn = 0; turn < 3; ++turn) {
      Mask mask = random.mask;
      if (turn == 1) {  // whole tiles of one value, which need not be read where its function is 0
        for (std::uint32_t y = 0; y < shape.height; ++y) {
          for (std::uint32_t x = 0; x < shape.width; ++x) {
            mask.tags[y * shape.width + x] = random.mask.tags[(y & ~7u) * shape.width + (x & ~7u)];
          }
        }
      }
      RenderControl control;
      control.precision = draw.pick(std::vector<Precision>(available.begin(), available.end()));
      if (draw.chance(0.3)) {
        const auto x = static_cast<std::uint32_t>(draw.whole(0, shape.width - 1));
        const auto y = static_cast<std::uint32_t>(draw.whole(0, shape.height - 1));
        control.rectangle = Rectangle{x, y, static_cast<std::uint32_t>(draw.whole(1, shape.width - x)),
                                      static_cast<std::uint32_t>(draw.whole(1, shape.height - y))};
      }
      const RenderPlan plan = make_plan(capture, short_functions(random.functions, random.timeline, draw), mask,
                                        {.unmapped_is_zero = true});
      const Picture expected = plain.render(plan, capture, kLight, control).picture;
      EXPECT_EQ(passing.render(plan, packed, kLight, control).picture, expected) << turn;
      EXPECT_EQ(holding.render(plan, packed, kLight, control).picture, expected) << turn;
      EXPECT_EQ(holding.render(plan, packed, kLight, control).picture, expected) << turn << ", again";
    }
    holding.keep_resident(nullptr);
    left_out += packed.groups_left_out;
    unpacked += packed.groups_unpacked;
  }
  EXPECT_GT(left_out, unpacked / 4);
  std::printf("%llu groups unpacked, %llu left out\n", static_cast<unsigned long long>(unpacked),
              static_cast<unsigned long long>(left_out));
}

// A mask of one region, whose background is 0: only the region's tile is unpacked.
TEST(NeededTiles, AreThoseOfTheFunctionsThatAreNotZero) {
  const CaptureFormat format{.shape = {64, 64, 3}};
  const Timeline timeline = Timeline::constant({100, 1}, Timeline::kFullShutter, 20);
  Random random(3);
  MemoryCapture capture(format, timeline, random_rasters(random, format, 20), 5);
  PackedCapture packed(capture, 1);
  Mask mask = Mask::uniform(64, 64, 0);
  for (std::uint32_t y = 8; y < 16; ++y) {
    for (std::uint32_t x = 16; x < 32; ++x) mask.tags[y * 64 + x] = 7;
  }
  FunctionSet functions;
  functions.emplace(std::uint8_t{7}, GainFunction::boxcar(0, 150'000'000));  // three blocks of four
  const RenderPlan plan = make_plan(capture, functions, mask, {.unmapped_is_zero = true});
  ASSERT_EQ(plan.blocks.size(), 3u);
  OpenClRenderer renderer(renderer_options(Precision::fixed));
  const Picture expected = renderer.render(plan, capture, kLight).picture;
  EXPECT_EQ(renderer.render(plan, packed, kLight).picture, expected);
  EXPECT_EQ(packed.groups_unpacked, 3u * 2);
  EXPECT_EQ(packed.groups_left_out, 3u * 62);
}

}  // namespace
}  // namespace nutik::test
