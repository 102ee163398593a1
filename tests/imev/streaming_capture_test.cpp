#include <gtest/gtest.h>

#include <algorithm>

#include "capture/format.hpp"
#include "imev/capture_source.hpp"
#include "support/payloads.hpp"
#include "support/random_case.hpp"
#include "support/raster_stream.hpp"

namespace nutik::test {
namespace {

TEST(StreamingCapture, GivesTheBlocksOfTheWholeCaptureAndReadsNoFurther) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    const std::uint64_t count = random.rasters.size();
    Random draw(seed + 1000);
    SampleRange needed;
    needed.first = static_cast<std::uint64_t>(draw.whole(0, static_cast<std::int64_t>(count) - 1));
    needed.last = static_cast<std::uint64_t>(
        draw.whole(static_cast<std::int64_t>(needed.first) + 1, static_cast<std::int64_t>(count)));
    const MemoryCapture whole = random.encode();
    RasterStream stream(random.rasters, count);
    StreamingCapture streaming(random.capture, random.timeline, needed, random.block_samples, random.policy,
                               std::ref(stream));
    for (std::uint64_t block = 0; block < streaming.block_count(); ++block) {
      const BlockExtent extent = streaming.block_extent(block);
      if (extent.range().last <= needed.first) continue;
      const auto payload = payload_of(streaming, block);
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

// A payload is lent where it was built, and stays for as long as that, whatever is built meanwhile.
TEST(StreamingCapture, LeavesAlonePayloadsThatAreLent) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture whole = random.encode();
    StreamingCapture streaming(random.capture, random.timeline, {0, random.rasters.size()}, random.block_samples,
                               random.policy, RasterStream(random.rasters));
    EXPECT_TRUE(streaming.is_forward_only());
    Random draw(seed);
    std::vector<BlockLease> leases;
    for (std::uint64_t block = 0; block < streaming.block_count(); ++block) {
      leases.push_back(streaming.acquire(block));
      EXPECT_EQ(leases.back().extent(), streaming.block_extent(block));
      for (const BlockLease& lease : leases) {
        const BlockView expected = whole.view(lease.extent().first_sample / random.block_samples);
        EXPECT_EQ(lease.bytes(), expected.payload().size());
        ASSERT_TRUE(std::ranges::equal(payload_of(random.capture, lease), expected.payload()))
            << random.text() << ", " << block;
      }
      // Some are given back, in any order, and their memory is used again.
      std::erase_if(leases, [&](const BlockLease&) { return draw.chance(0.4); });
    }
  }
}

// Whoever gives each block back before the next one never has a stream build in other memory.
TEST(StreamingCapture, BuildsWhereBlocksWereGivenBack) {
  const CaptureFormat format{.shape = {64, 48, 3}};
  const std::vector<std::vector<std::byte>> rasters(20, std::vector<std::byte>(format.sample_bytes()));
  StreamingCapture streaming(format, Timeline::constant({30, 1}, Timeline::kFullShutter, 20), {0, 20}, 4,
                             TilePolicy::automatic, RasterStream(rasters));
  const std::byte* first = streaming.acquire(0).payload().data();
  for (std::uint64_t block = 1; block < 5; ++block) {
    EXPECT_EQ(streaming.acquire(block).payload().data(), first);
  }
}

TEST(StreamingCapture, IsAskedForBlocksInOrder) {
  const std::vector<std::vector<std::byte>> rasters(9, std::vector<std::byte>(3));
  StreamingCapture streaming({.shape = {1, 1, 3}}, Timeline::constant({30, 1}, Timeline::kFullShutter, 9), {0, 9}, 3,
                             TilePolicy::automatic, RasterStream(rasters));
  EXPECT_EQ(streaming.acquire(1).extent(), (BlockExtent{3, 3}));
  for (const std::uint64_t block : {0u, 1u}) {
    EXPECT_THROW(static_cast<void>(streaming.acquire(block)), std::logic_error);
  }
  EXPECT_EQ(streaming.acquire(2).extent(), (BlockExtent{6, 3}));
}

TEST(StreamingCapture, TellsTheRealNumberOfSamples) {
  const RandomCase random(6);
  const std::uint64_t count = random.rasters.size();
  ASSERT_GT(count, 2u);
  for (const std::uint64_t announced : {count - 1, count + 5}) {
    RasterStream stream(random.rasters, count);
    const Timeline timeline = Timeline::constant({30, 1}, Timeline::kFullShutter, announced);
    StreamingCapture streaming(random.capture, timeline, {0, announced}, 7, TilePolicy::automatic,
                               std::ref(stream));
    std::uint64_t found = 0;
    try {
      for (std::uint64_t block = 0; block < streaming.block_count(); ++block) {
        static_cast<void>(streaming.acquire(block));
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
}  // namespace nutik::test
