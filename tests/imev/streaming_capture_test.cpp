#include <gtest/gtest.h>

#include <algorithm>

#include "capture/format.hpp"
#include "imev/capture_source.hpp"
#include "imev/payload_parts.hpp"
#include "support/random_case.hpp"
#include "support/raster_stream.hpp"

namespace nutik {
namespace {

using test::RandomCase;

TEST(StreamingCapture, GivesTheBlocksOfTheWholeCaptureAndReadsNoFurther) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    const std::uint64_t count = random.rasters.size();
    test::Random draw(seed + 1000);
    SampleRange needed;
    needed.first = static_cast<std::uint64_t>(draw.whole(0, static_cast<std::int64_t>(count) - 1));
    needed.last = static_cast<std::uint64_t>(
        draw.whole(static_cast<std::int64_t>(needed.first) + 1, static_cast<std::int64_t>(count)));
    const MemoryCapture whole = random.encode();
    test::RasterStream stream(random.rasters, count);
    StreamingCapture streaming(random.capture, random.timeline, needed, random.block_samples, random.policy,
                               std::ref(stream));
    for (std::uint64_t block = 0; block < streaming.block_count(); ++block) {
      const BlockExtent extent = streaming.block_extent(block);
      if (extent.range().last <= needed.first) continue;
      std::vector<std::byte> payload(streaming.prepare(block));
      streaming.read(block, payload);
      const BlockView view(random.capture, extent, payload);
      std::vector<std::byte> a(random.capture.sample_bytes()), b(a.size());
      for (std::uint32_t k = 0; k < extent.sample_count; ++k) {
        view.read_sample(k, a);
        whole.view(block).read_sample(k, b);
        ASSERT_EQ(a, b) << random.text() << ", block " << block << ", sample " << k;
      }
    }
    EXPECT_EQ(stream.read(), needed.last) << random.text();
  }
}

// A payload is lent where it was built, and stays while the next block is.
TEST(StreamingCapture, LendsPayloadsForTwoBlocks) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    MemoryCapture whole = random.encode();
    StreamingCapture streaming(random.capture, random.timeline, {0, random.rasters.size()},
                               random.block_samples, random.policy, test::RasterStream(random.rasters));
    const auto expect_block = [&](std::uint64_t block, std::span<const std::byte> lent) {
      const BlockExtent extent = streaming.block_extent(block);
      const PayloadParts parts(BlockGeometry(random.capture, extent.sample_count), lent);
      std::vector<std::byte> payload(parts.bytes());
      parts.copy_to(payload);
      ASSERT_TRUE(std::ranges::equal(payload, whole.view(block).payload())) << random.text() << ", " << block;
    };
    std::span<const std::byte> before;
    for (std::uint64_t block = 0; block < streaming.block_count(); ++block) {
      EXPECT_EQ(streaming.prepare(block), whole.prepare(block));
      expect_block(block, streaming.lent());
      if (block > 0) expect_block(block - 1, before);
      before = streaming.lent();
    }
  }
}

TEST(StreamingCapture, TellsTheRealNumberOfSamples) {
  const RandomCase random(6);
  const std::uint64_t count = random.rasters.size();
  ASSERT_GT(count, 2u);
  for (const std::uint64_t announced : {count - 1, count + 5}) {
    test::RasterStream stream(random.rasters, count);
    const Timeline timeline = Timeline::constant({30, 1}, Timeline::kFullShutter, announced);
    StreamingCapture streaming(random.capture, timeline, {0, announced}, 7, TilePolicy::automatic,
                               std::ref(stream));
    std::uint64_t found = 0;
    try {
      for (std::uint64_t block = 0; block < streaming.block_count(); ++block) {
        static_cast<void>(streaming.prepare(block));
      }
    } catch (const SampleCountMismatch& mismatch) {
      found = mismatch.sample_count;
      const InputError& error = mismatch;
      EXPECT_EQ(error.what(), format("the capture has {} samples where {} were expected", count, announced));
    }
    EXPECT_EQ(found, count) << "announced " << announced;
  }
}

}  // namespace
}  // namespace nutik
