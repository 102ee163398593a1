// The OpenCL renderer however captures are stored and the work is cut. Its arithmetics against the reference:
// precisions_test.cpp.
#include "opencl/opencl_renderer.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

// However the work is cut, the picture is the same within the bound: pixels of an item in one
// vector or in several, tiles of an item, work-groups that do not divide the picture, blocks read one
// launch each or all at once. Every vector width meets both depths, both numbers of channels, and light looked up
// and converted; meeting all their products would only take longer, since a kernel is built for
// each.
TEST(OpenClRenderer, DoesNotDependOnHowTheWorkIsCut) {
  struct Cut {
    std::uint32_t item_pixels, item_tiles, lanes, group_items;
    std::uint64_t chunk_bytes;
  };
  const Cut cuts[] = {
      {1, 1, 1, 1, 0}, {1, 1, 1, 64, 1}, {16, 3, 4, 3, 0}, {8, 16, 8, 16, 4096}, {16, 1000, 16, 2, 1}};
  const CodeFormat formats[] = {{3, 1, 255, Transfer::srgb()}, {1, 2, 4095, Transfer::linear()}};
  ReferenceRenderer reference;
  for (const Cut& cut : cuts) {
    OpenClOptions options = renderer_options(precise());
    options.item_pixels = cut.item_pixels;
    options.item_tiles = cut.item_tiles;
    options.lanes = cut.lanes;
    options.group_items = cut.group_items;
    options.chunk_bytes = cut.chunk_bytes;
    OpenClRenderer renderer(options);
    for (std::uint64_t seed = 1000; seed < 1030; ++seed) {
      const RandomCase random(seed, formats[seed % std::size(formats)]);
      MemoryCapture capture = random.encode();
      const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
      const Difference difference =
          share_of_bound(plan, precise(), renderer.render(plan, capture, {ValueType::light64, 0}).picture,
                         reference.render(plan, capture, {ValueType::light64, 0}).picture);
      ASSERT_LE(difference.worst, 1.0)
          << random.text() << ", " << cut.item_pixels << " pixels of " << cut.item_tiles
          << " tiles an item in " << cut.lanes << " lanes, value " << difference.value;
    }
  }
}

// Every kind of tile and length of block holds the same capture.
TEST(OpenClRenderer, DoesNotDependOnTilesOrBlocks) {
  OpenClRenderer renderer(renderer_options(precise()));
  for (std::uint64_t seed = 2000; seed < 2020; ++seed) {
    const RandomCase random(seed);
    MemoryCapture plain = random.encode(64, TilePolicy::dense);
    const RenderPlan plan = make_plan(plain, random.functions, random.mask, {});
    const Picture expected = renderer.render(plan, plain, {ValueType::light64, 0}).picture;
    for (const std::uint32_t block_samples : {1u, 2u, 64u, 1000u}) {
      for (const TilePolicy policy :
           {TilePolicy::automatic, TilePolicy::dense, TilePolicy::rows, TilePolicy::records}) {
        MemoryCapture capture = random.encode(block_samples, policy);
        const RenderPlan other = make_plan(capture, random.functions, random.mask, {});
        const Difference difference =
            difference_of(plan, renderer.render(other, capture, {ValueType::light64, 0}).picture, expected);
        ASSERT_LE(difference.worst, kDoubleAgainstReference)
            << random.text() << ", blocks of " << block_samples << ", tiles " << to_text(policy);
      }
    }
  }
}

// Blocks of more than 255 samples index them with 16 bits.
TEST(OpenClRenderer, ReadsBlocksOfAnyLength) {
  constexpr std::uint64_t kSamples = 600;
  OpenClRenderer renderer(renderer_options(precise()));
  ReferenceRenderer reference;
  Random random(3000);
  const CaptureFormat format{.shape = {17, 9, 1}};
  const Rasters rasters = random_rasters(random, format, kSamples);
  for (const std::uint32_t block_samples : {254u, 255u, 256u, 257u, 1000u}) {
    for (const TilePolicy policy :
         {TilePolicy::automatic, TilePolicy::dense, TilePolicy::rows, TilePolicy::records}) {
      const Timeline timeline = random_timeline(random, kSamples);
      MemoryCapture capture(format, timeline, rasters, block_samples, policy);
      const FunctionSet functions{{0, random_function(random, timeline)}, {1, random_function(random, timeline)}};
      Mask mask = Mask::uniform(17, 9, 0);
      for (std::size_t pixel = 0; pixel < mask.tags.size() / 2; ++pixel) {
        mask.tags[pixel] = static_cast<std::uint8_t>(random.whole(0, 1));
      }
      const RenderPlan plan = make_plan(capture, functions, mask, {});
      const Difference difference =
          share_of_bound(plan, precise(), renderer.render(plan, capture, {ValueType::light64, 0}).picture,
                         reference.render(plan, capture, {ValueType::light64, 0}).picture);
      ASSERT_LE(difference.worst, 1.0)
          << "blocks of " << block_samples << ", tiles " << to_text(policy) << ", value " << difference.value;
    }
  }
}

TEST(OpenClRenderer, NothingLiveIsBlack) {
  const RandomCase random(1);
  MemoryCapture capture = random.encode();
  const FunctionSet zero{{0, GainFunction({{0, 0.0}})}};
  const Mask mask = Mask::uniform(random.capture.shape.width, random.capture.shape.height, 0);
  const RenderPlan plan = make_plan(capture, zero, mask, {});
  OpenClRenderer renderer(renderer_options(precise()));
  const Rendered rendered = renderer.render(plan, capture, {ValueType::code8, 255});
  for (const std::uint8_t code : rendered.picture.values<std::uint8_t>()) ASSERT_EQ(code, 0);
  EXPECT_EQ(rendered.statistics.launches, 0u);
}

TEST(OpenClRenderer, ReadsOnlyTheBlocksOfThePlan) {
  const Rasters rasters(100, std::vector<std::byte>(256, std::byte{90}));
  MemoryCapture capture({.shape = {16, 16, 1}}, Timeline::constant({100, 1}, Timeline::kFullShutter, 100), rasters, 10);
  const FunctionSet functions{{0, GainFunction::boxcar(250'000'000, 260'000'000)}};
  const RenderPlan plan = make_plan(capture, functions, Mask::uniform(16, 16, 0), {});
  OpenClRenderer renderer(renderer_options(precise()));
  const Rendered rendered = renderer.render(plan, capture, {ValueType::code8, 255});
  EXPECT_EQ(rendered.statistics.blocks, 1u);
  EXPECT_EQ(rendered.statistics.payload_bytes,
            64u + 4 * 64u);  // a directory and four still tiles
  EXPECT_EQ(rendered.picture.values<std::uint8_t>()[0], 90);
}

// A script may open captures by the thousand.
TEST(OpenClRenderer, KeepsNoMapsOfCapturesThatAreGone) {
  OpenClRenderer renderer(renderer_options(precise()));
  std::vector<std::weak_ptr<const MaskMap>> maps;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const RandomCase random(seed);
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    static_cast<void>(renderer.render(plan, capture, {ValueType::light64, 0}));
    const Rendered again = renderer.render(plan, capture, {ValueType::light64, 0});
    EXPECT_EQ(again.statistics.map_bytes_written, 0u);
    maps.push_back(plan.map);
  }
  EXPECT_TRUE(maps[0].expired());
  EXPECT_TRUE(maps[1].expired());
}

}  // namespace
}  // namespace nutik::test
