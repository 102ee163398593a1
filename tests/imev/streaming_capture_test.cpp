#include <gtest/gtest.h>

#include "capture/format.hpp"
#include "imev/capture_source.hpp"
#include "support/random_case.hpp"

namespace nutik {
namespace {

using test::RandomCase;

// A stream of a random case's samples that counts how far it was read.
struct CountingStream {
  const RandomCase& random;
  std::uint64_t read = 0;
  std::uint64_t end;

  std::vector<std::span<const std::byte>> rasters = {};

  std::span<const std::span<const std::byte>> operator()(std::uint64_t most) {
    rasters.clear();
    while (read < end && rasters.size() < most) rasters.emplace_back(random.rasters[read++]);
    return rasters;
  }
};

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
    CountingStream stream{random, 0, count};
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
    EXPECT_EQ(stream.read, needed.last) << random.text();
  }
}

TEST(StreamingCapture, TellsTheRealNumberOfSamples) {
  const RandomCase random(6);
  const std::uint64_t count = random.rasters.size();
  ASSERT_GT(count, 2u);
  for (const std::uint64_t announced : {count - 1, count + 5}) {
    CountingStream stream{random, 0, count};
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
