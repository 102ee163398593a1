// Blocks close by what they hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "imev/block_builder.hpp"
#include "imev/capture_source.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// The samples of each block of these, given to the builder so many at a time, as far as it has room.
std::vector<std::uint32_t> block_lengths(const CaptureFormat& format, const BlockLimits& limits, const Rasters& rasters,
                                         std::size_t at_once) {
  BlockBuilder builder(format, limits, TilePolicy::automatic);
  std::vector<std::uint32_t> lengths;
  PageBuffer payload;
  for (std::size_t k = 0; k < rasters.size();) {
    const std::size_t count = std::min({at_once, rasters.size() - k, std::size_t{builder.room()}});
    std::vector<std::span<const std::byte>> samples(rasters.begin() + static_cast<std::ptrdiff_t>(k),
                                                    rasters.begin() + static_cast<std::ptrdiff_t>(k + count));
    builder.add(samples);
    k += count;
    if (!builder.is_full()) continue;
    lengths.push_back(builder.extent().sample_count);
    builder.finish(payload);
  }
  if (!builder.is_empty()) lengths.push_back(builder.extent().sample_count);
  return lengths;
}

// Grey, 4 tiles of 64 bytes a row; with sample k the first `changing(k)` of them change.
template <typename Changing>
Rasters four_tiles(std::size_t samples, Changing changing) {
  Rasters rasters(samples, std::vector<std::byte>(256));
  for (std::size_t k = 1; k < samples; ++k) {
    rasters[k] = rasters[k - 1];
    for (std::size_t tile = 0; tile < changing(k); ++tile) {
      rasters[k][tile * 8] = static_cast<std::byte>(std::to_integer<unsigned>(rasters[k][tile * 8]) ^ 1u);
    }
  }
  return rasters;
}

CaptureFormat four_tiles_format() { return {.shape = {32, 8, 1}}; }

TEST(BlockLimits, CloseABlockWithTheSampleThatReachesThem) {
  using Lengths = std::vector<std::uint32_t>;
  const auto still = four_tiles(150, [](std::size_t) { return 0u; });
  const auto busy = four_tiles(12, [](std::size_t) { return 4u; });
  const auto one_tile = four_tiles(22, [](std::size_t) { return 1u; });
  const auto flash = four_tiles(150, [](std::size_t k) { return k == 30 ? 4u : 0u; });
  for (const std::size_t at_once : {1u, 2u, 3u, 4u, 100u}) {
    const auto lengths = [&](std::uint64_t changed_bytes, const Rasters& rasters) {
      return block_lengths(four_tiles_format(), {64, changed_bytes}, rasters, at_once);
    };
    EXPECT_EQ(lengths(1, still), (Lengths{64, 64, 22})) << at_once;
    EXPECT_EQ(lengths(1, busy), (Lengths{2, 2, 2, 2, 2, 2})) << at_once;
    EXPECT_EQ(lengths(256, busy), (Lengths{2, 2, 2, 2, 2, 2})) << at_once;
    EXPECT_EQ(lengths(257, busy), (Lengths{3, 3, 3, 3})) << at_once;
    EXPECT_EQ(lengths(1024, busy), (Lengths{5, 5, 2})) << at_once;
    EXPECT_EQ(lengths(10 * 64, one_tile), (Lengths{11, 11})) << at_once;
    EXPECT_EQ(lengths(256, flash), (Lengths{31, 64, 55})) << at_once;
    EXPECT_EQ(lengths(BlockLimits::kAnyChanges, busy), (Lengths{12})) << at_once;
  }
}

// Wherever blocks are cut and rooms moved, samples are held as they were.
TEST(BlockLimits, ChangeNothingOfWhatIsHeld) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomCase random(seed);
    random.capture.noise = {};
    Random draw(seed);
    const std::uint64_t raw = random.capture.sample_bytes();
    BlockLimits limits(static_cast<std::uint32_t>(draw.whole(1, 300)),
                       static_cast<std::uint64_t>(draw.whole(1, static_cast<std::int64_t>(6 * raw))));
    if (draw.chance(0.5)) limits.memory_bytes = static_cast<std::uint64_t>(draw.whole(1, 400'000));
    const MemoryCapture capture(random.capture, random.timeline, random.rasters, limits, random.policy);
    std::uint64_t samples = 0;
    std::vector<std::byte> held(raw);
    for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
      const BlockView view = capture.view(block);
      for (std::uint32_t k = 0; k < view.extent().sample_count; ++k, ++samples) {
        view.read_sample(k, held);
        ASSERT_EQ(held, random.rasters[samples]) << random.text() << ", block " << block << ", sample " << k;
      }
    }
    EXPECT_EQ(samples, random.rasters.size());
  }
}

// Tiles that change at their own times leave rooms behind: what a block takes while it is built stays within twice the
// limit and a sample all the same.
TEST(BlockLimits, KeepToTheirMemory) {
  const CaptureFormat format{.shape = {256, 256, 1}};
  const BlockGeometry geometry(format, 64);
  const std::uint64_t sample = geometry.tile_count * (geometry.row_bytes() + kBlockAlignment);
  const TileGrid grid(format.shape);
  double most = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const auto memory = static_cast<std::uint64_t>(random.whole(1, static_cast<std::int64_t>(30 * sample)));
    BlockLimits limits = default_block_limits(format, memory);
    limits.memory_bytes = memory;
    BlockBuilder builder(format, limits, TilePolicy::automatic);
    std::vector<std::byte> raster(format.sample_bytes());
    PageBuffer payload;
    const auto every = static_cast<std::uint64_t>(random.whole(1, 4));
    std::uint64_t blocks = 0;
    for (std::uint64_t k = 0; k < 150; ++k) {
      const double share = k % every == 0 ? 1.0 : random.real(0, 0.6);
      for (std::uint64_t tile = 0; tile < grid.tile_count(); ++tile) {
        if (!random.chance(share)) continue;
        const std::uint64_t pixel = tile / grid.columns() * 8 * 256 + tile % grid.columns() * 8;
        raster[pixel] = static_cast<std::byte>(static_cast<int>(raster[pixel]) + 1);
      }
      builder.add(raster);
      if (!builder.is_full()) continue;
      const FinishedBlock finished = builder.finish(payload);
      ++blocks;
      const double allowed =
          2.0 * static_cast<double>(memory) + static_cast<double>(2 * sample + geometry.directory_bytes());
      most = std::max(most, static_cast<double>(finished.span_bytes) / allowed);
      ASSERT_LE(static_cast<double>(finished.span_bytes), allowed) << "seed " << seed << ", sample " << k;
    }
    EXPECT_GT(blocks, 2u) << seed;
  }
  std::printf("at most %.2f of what is allowed\n", most);
}

TEST(BlockLimits, FollowTheContentUnlessTheNoiseIsKnown) {
  CaptureFormat format;
  for (const Shape& shape : {Shape{640, 480, 3}, Shape{1920, 1080, 3}, Shape{7680, 4320, 3}}) {
    format.shape = shape;
    EXPECT_EQ(default_block_limits(format).samples, 64u);
    EXPECT_EQ(default_block_limits(format).changed_bytes, 128u << 20);
  }
  // Little memory: the first sample and the one that is one too many are part of a block.
  const std::uint64_t raw = format.sample_bytes();
  EXPECT_EQ(default_block_limits(format, 3 * raw).changed_bytes, raw);
  EXPECT_EQ(default_block_limits(format, 3 * raw - 1).samples, default_block_samples(format, 128u << 20));

  CaptureFormat noisy{.shape = {1920, 1080, 3}};
  noisy.noise.camera.emplace();
  EXPECT_EQ(default_block_limits(noisy).samples, default_block_samples(noisy));
  EXPECT_EQ(default_block_limits(noisy).changed_bytes, BlockLimits::kAnyChanges);
}

// 8K, 64 samples, 6.4 GB as rasters: 2 % of the tiles change at every sample, others every time.
TEST(BlockLimits, KeepALargeSceneInOneBlock) {
  const CaptureFormat format{.shape = {7680, 4320, 3}};
  BlockBuilder builder(format, default_block_limits(format), TilePolicy::automatic);
  std::vector<std::byte> raster(format.sample_bytes());
  const TileGrid grid(format.shape);
  Random random(1);
  for (std::uint32_t k = 0; k < 64; ++k) {
    for (std::uint64_t i = 0; k > 0 && i < grid.tile_count() / 50; ++i) {
      const auto tile =
          static_cast<std::uint64_t>(random.whole(0, static_cast<std::int64_t>(grid.tile_count()) - 1));
      const std::uint64_t pixel = tile / grid.columns() * 8 * 7680 + tile % grid.columns() * 8;
      std::fill_n(raster.begin() + static_cast<std::ptrdiff_t>(pixel * 3), 24, static_cast<std::byte>(k));
    }
    ASSERT_FALSE(builder.is_full()) << k;
    builder.add(raster);
  }
  EXPECT_TRUE(builder.is_full());
  EXPECT_EQ(builder.extent().sample_count, 64u);
  PageBuffer payload;
  const FinishedBlock finished = builder.finish(payload);
  const double raw = 64.0 * static_cast<double>(format.sample_bytes());
  const double share = static_cast<double>(finished.payload_bytes) / raw;
  const double spread = static_cast<double>(finished.span_bytes) / raw;
  std::printf("64 samples of 8K: %.3f of their raw bytes, %.3f where they were built\n", share, spread);
  EXPECT_LT(share, 0.05);
  EXPECT_LT(spread, 0.1);
}

// Tiles begin to change at different samples, so that some have room for their rows and others get a larger one.
TEST(BlockLimits, BlocksAreTheSameOnAnyNumberOfThreads) {
  CaptureFormat format;
  format.shape = {1023, 515, 3};  // several parts for threads, and tiles that reach beyond the picture
  Random random(1);
  Rasters rasters(21, std::vector<std::byte>(format.sample_bytes()));
  for (std::size_t k = 1; k < rasters.size(); ++k) {
    rasters[k] = rasters[k - 1];
    for (std::size_t change = 0; change < 200 * k; ++change) {
      const auto last = static_cast<std::int64_t>(rasters[k].size() - 1);
      rasters[k][static_cast<std::size_t>(random.whole(0, last))] ^= std::byte{0x41};
    }
  }
  const auto built = [&](std::uint32_t threads) {
    BlockBuilder builder(format, BlockLimits(64), TilePolicy::automatic, threads);
    for (std::size_t k = 0; k < rasters.size(); k += BlockBuilder::kSamplesAtOnce) {
      const std::size_t last = std::min(rasters.size(), k + BlockBuilder::kSamplesAtOnce);
      const std::vector<std::span<const std::byte>> samples(rasters.begin() + static_cast<std::ptrdiff_t>(k),
                                                            rasters.begin() + static_cast<std::ptrdiff_t>(last));
      builder.add(samples);
    }
    PageBuffer payload;
    const FinishedBlock finished = builder.finish(payload);
    return std::pair(finished.record_count, std::vector(payload.data(), payload.data() + finished.span_bytes));
  };
  EXPECT_EQ(built(1), built(2));
}

}  // namespace
}  // namespace nutik::test
