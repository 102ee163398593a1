// The lightest and darkest sample on a device: the reference's to the last bit, however captures are stored and the
// work is cut. What the reference is held to: render/combining_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "opencl/opencl_renderer.hpp"
#include "opencl/validation.hpp"
#include "render/reference_renderer.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"
#include "support/soft_mask.hpp"

namespace nutik::test {
namespace {

// Gains of a random function that are not below 0, or one gain while its live interval lasts.
FunctionSet functions_of(const RandomCase& random, bool scales) {
  FunctionSet functions;
  for (const auto& [tag, function] : random.functions) {
    std::vector<ControlPoint> points(function.points().begin(), function.points().end());
    if (!scales && !points.empty()) {
      const std::int64_t first_ns = points.front().time_ns, last_ns = points.back().time_ns;
      functions.emplace(tag, GainFunction::boxcar(first_ns, std::max(last_ns, first_ns + 1), 0.3 + tag));
      continue;
    }
    for (ControlPoint& point : points) point.gain = std::abs(point.gain);
    functions.emplace(tag, GainFunction(points));
  }
  return functions;
}

// By the values themselves: 0.0 and -0.0 are the same light.
void expect_the_references(OpenClRenderer& renderer, const RandomCase& random, MemoryCapture& capture,
                           const RenderControl& control = {}) {
  for (const bool scales : {false, true}) {
    for (const Combine how : {Combine::lighten, Combine::darken, Combine::median}) {
      const RenderPlan plan = make_plan(capture, functions_of(random, scales), random.mask, {.combine = how});
      for (const OutputFormat& output : {kLight, OutputFormat{ValueType::code8, 255}}) {
        const Rendered found = renderer.render(plan, capture, output, control);
        const Rendered expected = ReferenceRenderer().render(plan, capture, output, control);
        ASSERT_EQ(found.picture.shape, expected.picture.shape);
        EXPECT_EQ(found.saturation.below, expected.saturation.below);
        EXPECT_EQ(found.saturation.above, expected.saturation.above);
        ASSERT_TRUE(found.warnings.empty());
        if (how != Combine::median && !plan.blocks.empty()) {
          ASSERT_GE(found.statistics.launches, 1u);
        }
        for (std::size_t i = 0; i < found.picture.shape.value_count(); ++i) {
          const bool is_same = output.type == ValueType::light64
                                   ? found.picture.values<double>()[i] == expected.picture.values<double>()[i]
                                   : found.picture.bytes[i] == expected.picture.bytes[i];
          ASSERT_TRUE(is_same) << random.text() << ", value " << i << ", " << static_cast<int>(how) << ", scales "
                               << scales << "; rerun: " << rerun(random.seed);
        }
      }
    }
  }
}

TEST(CombiningOnDevices, IsTheReferencesToTheLastBit) {
  OpenClRenderer renderer(renderer_options({}));
  const Seeds seeds = test::seeds(0, 40);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const RandomCase random(seed);
    MemoryCapture capture = random.encode();
    expect_the_references(renderer, random, capture);
  }
}

// Every vector width, both depths, one channel and three; blocks of a launch each and all at once.
TEST(CombiningOnDevices, DoesNotDependOnHowTheWorkIsCut) {
  const std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint64_t> cuts[] = {
      {1, 1, 1, 1, 0}, {4, 1, 4, 64, 1}, {16, 3, 4, 3, 0}, {8, 16, 8, 16, 4096}, {64, 16, 16, 1, 1}};
  const CodeFormat formats[] = {{3, 1, 255, Transfer::srgb()}, {1, 2, 4095, Transfer::linear()}};
  for (const auto& [item_pixels, item_tiles, lanes, group_items, chunk_bytes] : cuts) {
    OpenClOptions options = renderer_options({});
    options.item_pixels = item_pixels;
    options.item_tiles = item_tiles;
    options.lanes = lanes;
    options.group_items = group_items;
    options.chunk_bytes = chunk_bytes;
    OpenClRenderer renderer(options);
    for (std::uint64_t seed = 1000; seed < 1010; ++seed) {
      const RandomCase random(seed, formats[seed % std::size(formats)]);
      MemoryCapture capture = random.encode();
      expect_the_references(renderer, random, capture);
    }
  }
}

// Also blocks whose samples are counted in 16 bits, and captures that stay on the device.
TEST(CombiningOnDevices, DoesNotDependOnTilesOrBlocks) {
  OpenClRenderer renderer(renderer_options({}));
  for (const std::uint32_t block_samples : {1u, 2u, 64u, 1000u}) {
    for (const TilePolicy policy :
         {TilePolicy::automatic, TilePolicy::dense, TilePolicy::rows, TilePolicy::records}) {
      for (std::uint64_t seed = 2000; seed < 2004; ++seed) {
        const RandomCase random(seed);
        MemoryCapture capture = random.encode(block_samples, policy);
        renderer.keep_resident(&capture);
        expect_the_references(renderer, random, capture);
        renderer.keep_resident(nullptr);
      }
    }
  }
}

TEST(CombiningOnDevices, BlendsAndCutsAsTheReferenceDoes) {
  OpenClOptions options = renderer_options({});
  options.allocation_bytes = 150'000;
  OpenClRenderer renderer(options);
  for (std::uint64_t seed = 3000; seed < 3020; ++seed) {
    RandomCase random(seed, {3, 1, 255, Transfer::srgb()});
    MemoryCapture capture = random.encode();
    soften(random.mask, random.functions, seed);
    const Shape& shape = random.capture.shape;
    expect_the_references(renderer, random, capture,
                          {.rectangle = Rectangle{shape.width / 3, shape.height / 4, shape.width - shape.width / 3,
                                                  (shape.height + 1) / 2}});
    expect_the_references(renderer, random, capture);
  }
}

// A driver that takes the darkest for the lightest is not believed.
TEST(CombiningOnDevices, IsTheProcessorsWhereADriverIsWrong) {
  OpenClOptions options = renderer_options({});
  options.tests_itself = true;
  options.cache_folder.clear();
  for (const Precision precision : first_precisions()) options.faults[precision] = "-DNUTIK_DARKENS=1";
  OpenClRenderer renderer(options);
  const RandomCase random(17);
  MemoryCapture capture = random.encode();
  for (const bool scales : {false, true}) {
    const RenderPlan plan =
        make_plan(capture, functions_of(random, scales), random.mask, {.combine = Combine::lighten});
    const Rendered found = renderer.render(plan, capture, kLight);
    ASSERT_EQ(found.warnings.size(), 1u);
    expect_says(found.warnings.front(), "combines light wrongly (self-test: ");
    EXPECT_EQ(found.picture.bytes, ReferenceRenderer().render(plan, capture, kLight).picture.bytes);
  }
}

// A device without faults passes the test of itself, and validation allows no difference.
TEST(CombiningOnDevices, IsValidated) {
  OpenClOptions options = renderer_options({});
  options.tests_itself = true;
  OpenClRenderer renderer(options);
  const RandomCase random(17);
  MemoryCapture capture = random.encode();
  for (const bool scales : {false, true}) {
    const RenderPlan plan =
        make_plan(capture, functions_of(random, scales), random.mask, {.combine = Combine::lighten});
    EXPECT_TRUE(renderer.render(plan, capture, kLight).warnings.empty());
    const Validation validation = validate(plan, capture, {ValueType::code8, 255}, renderer, 1, [](auto, auto) {});
    ASSERT_EQ(validation.variants.size(), 1u);
    EXPECT_EQ(validation.variants.front().light.worst, 0.0);
    EXPECT_EQ(validation.variants.front().stored.differing, 0u);
    EXPECT_TRUE(validation.is_within_bounds());
  }
}

}  // namespace
}  // namespace nutik::test
