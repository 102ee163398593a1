// A block that is told what changes is the block that is given whole samples.
#include <gtest/gtest.h>

#include <algorithm>

#include "capture/error.hpp"
#include "imev/block_builder.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// What differs between two samples, with some pixels that do not, and some that are told twice.
std::vector<PixelChange> changes_between(Random& random, const CaptureFormat& capture,
                                         const std::vector<std::byte>& before,
                                         const std::vector<std::byte>& after) {
  std::vector<PixelChange> changes;
  for (std::uint32_t pixel = 0; pixel < capture.shape.pixel_count(); ++pixel) {
    PixelChange change{pixel, {}};
    bool differs = false;
    for (std::uint32_t c = 0; c < capture.shape.channels; ++c) {
      const std::uint64_t value = std::uint64_t{pixel} * capture.shape.channels + c;
      change.codes[c] = static_cast<std::uint16_t>(code_at(capture, after, value));
      differs |= code_at(capture, before, value) != change.codes[c];
    }
    if (!differs && !random.chance(0.02)) continue;
    if (random.chance(0.1)) changes.push_back({pixel, {}});
    changes.push_back(change);
  }
  // In any order, but for those of one pixel.
  for (std::size_t i = changes.size(); i-- > 1;) {
    const auto j = static_cast<std::size_t>(random.whole(0, static_cast<std::int64_t>(i)));
    if (changes[i].pixel != changes[j].pixel &&
        std::ranges::count(changes, changes[i].pixel, &PixelChange::pixel) == 1 &&
        std::ranges::count(changes, changes[j].pixel, &PixelChange::pixel) == 1) {
      std::swap(changes[i], changes[j]);
    }
  }
  return changes;
}

struct Closed {
  BlockExtent extent;
  PageBuffer payload;
  FinishedBlock finished;
};

template <typename Add>
std::vector<Closed> blocks(BlockBuilder& builder, const Rasters& rasters, Add add) {
  std::vector<Closed> all;
  const auto close = [&] {
    Closed block{builder.extent(), {}, {}};
    block.finished = builder.finish(block.payload);
    all.push_back(std::move(block));
  };
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    add(k);
    if (builder.is_full()) close();
  }
  if (!builder.is_empty()) close();
  return all;
}

TEST(ToldChanges, MakeTheBlocksOfWholeSamples) {
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    Random random(seed);
    CaptureFormat capture = random_format(random);
    if (random.chance(0.3)) capture.noise.tolerance = static_cast<std::uint32_t>(random.whole(1, 20));
    const Rasters rasters = random_rasters(random, capture, static_cast<std::uint64_t>(random.whole(1, 40)));
    const TilePolicy policy = random.chance(0.3) ? TilePolicy::records : TilePolicy::automatic;
    const BlockLimits limits(static_cast<std::uint32_t>(random.whole(1, 30)));
    BlockBuilder whole(capture, limits, policy), told(capture, limits, policy);
    ASSERT_TRUE(told.takes_changes());
    auto expected = blocks(whole, rasters, [&](std::size_t k) { whole.add(rasters[k]); });
    auto found = blocks(told, rasters, [&](std::size_t k) {
      if (told.is_empty()) {
        told.add(rasters[k]);
      } else {
        told.add_changes(changes_between(random, capture, rasters[k - 1], rasters[k]));
      }
    });
    ASSERT_EQ(found.size(), expected.size()) << "seed " << seed;
    for (std::size_t b = 0; b < found.size(); ++b) {
      ASSERT_EQ(found[b].extent, expected[b].extent) << "seed " << seed;
      EXPECT_EQ(found[b].finished.payload_bytes, expected[b].finished.payload_bytes) << "seed " << seed;
      EXPECT_EQ(found[b].finished.record_count, expected[b].finished.record_count) << "seed " << seed;
      const BlockView a(capture, found[b].extent, found[b].payload.first(found[b].finished.span_bytes));
      std::uint64_t records = 0;
      std::vector<ChangeRecord> history;
      for (std::uint32_t y = 0; y < capture.shape.height; ++y) {
        for (std::uint32_t x = 0; x < capture.shape.width; ++x) {
          a.read_history(TileGrid(capture.shape).tile_of(x, y), TileGrid::lane_of(x, y), history);
          records += history.size() - 1;
        }
      }
      EXPECT_EQ(found[b].finished.record_count, records) << "seed " << seed << ": of pixels, and not of padding";
      const BlockView e(capture, expected[b].extent, expected[b].payload.first(expected[b].finished.span_bytes));
      for (std::uint64_t tile = 0; tile < a.geometry().tile_count; ++tile) {
        ASSERT_EQ(a.entry(tile).count, e.entry(tile).count) << "seed " << seed << ", tile " << tile;
        ASSERT_TRUE(std::ranges::equal(a.body(tile), e.body(tile))) << "seed " << seed << ", tile " << tile;
      }
    }
  }
}

TEST(ToldChanges, OfASampleThatBeginsABlockAreRefused) {
  BlockBuilder builder({.shape = {9, 9, 1}}, 4, TilePolicy::automatic);
  EXPECT_THROW(builder.add_changes({}), std::logic_error);
  builder.add(std::vector<std::byte>(81));
  const PixelChange outside{81, {1}};
  EXPECT_THROW(builder.add_changes({&outside, 1}), std::logic_error);
}

TEST(ToldChanges, AboveWhiteAreRefusedAsCodesOfPicturesAre) {
  BlockBuilder builder({.shape = {9, 9, 1}, .white_code = 200}, 4, TilePolicy::automatic);
  builder.add(std::vector<std::byte>(81));
  const PixelChange change{3, {201}};
  EXPECT_EQ(message_of<InputError>([&] {
              builder.add_changes({&change, 1});
            }),
            "sample 1 has a code of 201, above the white code 200; state the right one");
}

TEST(ToldChanges, AreNotTakenWhereAllTilesAreDenseOrNoiseIsKnown) {
  EXPECT_FALSE(BlockBuilder({.shape = {9, 9, 1}}, 4, TilePolicy::dense).takes_changes());
}

}  // namespace
}  // namespace nutik::test
