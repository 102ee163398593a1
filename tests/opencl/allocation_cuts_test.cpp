// How exposures are cut where the device allocates little at a time. What comes of it: small_allocations_test.cpp.
#include "opencl/allocation_cuts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "opencl/kernel_layout.hpp"
#include "opencl/kernel_numbers.hpp"
#include "opencl/work_shape.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

// Bands stand one under the other, are as few as can be, and everything that belongs to one fits.
TEST(AllocationCuts, BandsTileAnyPicture) {
  for (const Shape& shape :
       {Shape{1, 1, 1}, Shape{8, 8, 3}, Shape{43, 37, 3}, Shape{7, 200, 1}, Shape{999, 65, 3}}) {
    const TileGrid grid(shape);
    for (const Precision precision : kPrecisions) {
      const std::uint64_t row_bytes = sums_bytes(grid.columns(), shape.channels, precision);
      for (std::uint32_t rows = 1; rows <= grid.rows() + 1; ++rows) {
        const std::uint64_t limit = (rows + 1) * row_bytes - 1;
        const std::vector<Band> bands =
            cut_picture(shape, Rectangle::whole(shape), precision, device_allocating(limit));
        ASSERT_EQ(bands.size(), (grid.rows() + rows - 1) / rows) << limit;
        const DeviceInfo large = device_allocating(1 << 30);
        EXPECT_EQ(cut_picture(shape, Rectangle::whole(shape), precision, large, limit), bands);
        std::uint64_t tile = 0;
        std::uint32_t row = 0;
        for (const Band& band : bands) {
          EXPECT_EQ(band.first_tile, tile);
          EXPECT_EQ(band.first_row, row);
          EXPECT_EQ(band.tile_count, TileGrid(band.shape).tile_count());
          EXPECT_EQ(band.shape.width, shape.width);
          EXPECT_EQ(band.shape.channels, shape.channels);
          EXPECT_LE(sums_bytes(band.tile_count, shape.channels, precision), limit);
          EXPECT_LE(band.shape.value_count() * sum_bytes(precision), limit);  // a raster of sums, or of codes
          EXPECT_LE(band.tile_count * kTilePixels, limit);
          tile += band.tile_count;
          row += band.shape.height;
        }
        EXPECT_EQ(tile, grid.tile_count());
        EXPECT_EQ(row, shape.height);
      }
    }
  }
}

// The tiles that a rectangle meets and no others, each once.
TEST(AllocationCuts, BandsOfARectangleHoldItsTiles) {
  const Shape shape{43, 77, 1};
  const TileGrid grid(shape);
  for (const Rectangle& rectangle : {Rectangle{0, 0, 43, 77}, Rectangle{42, 76, 1, 1}, Rectangle{7, 8, 2, 9},
                                     Rectangle{8, 15, 24, 50}, Rectangle{0, 30, 43, 3}}) {
    std::vector<std::uint64_t> wanted;
    for (std::uint32_t y = rectangle.y; y < rectangle.y + rectangle.height; ++y) {
      for (std::uint32_t x = rectangle.x; x < rectangle.x + rectangle.width; ++x) {
        wanted.push_back(grid.tile_of(x, y));
      }
    }
    std::ranges::sort(wanted);
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    for (const std::uint64_t limit : {6 * 64 * 4u, 3 * 6 * 64 * 4u, 1u << 20}) {
      std::vector<std::uint64_t> tiles;
      for (const Band& band : cut_picture(shape, rectangle, Precision::single_, device_allocating(limit))) {
        EXPECT_EQ(band.tile_count, TileGrid(band.shape).tile_count());
        for (std::uint64_t tile = 0; tile < band.tile_count; ++tile) {
          tiles.push_back(band.tile_in_picture(tile));
        }
      }
      EXPECT_EQ(tiles, wanted) << limit;
    }
  }
}

TEST(AllocationCuts, SlicesHoldEveryBlockOnce) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    const MemoryCapture capture =
        random.encode(static_cast<std::uint32_t>(1 + seed % 5), TilePolicy::automatic);
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    for (const Precision precision : kPrecisions) {
      const std::uint64_t row_bytes = plan.function_count() * weight_bytes(precision);
      std::uint64_t block_rows = 0;
      // Weights are there in whole groups of rows.
      const auto whole_groups = [](std::uint64_t rows) { return align_up(rows, WorkShape::kMaxTableRows); };
      for (const PlannedBlock& block : plan.blocks) {
        block_rows = std::max(block_rows, whole_groups(block.row_count()));
      }
      const std::uint64_t smallest = std::max<std::uint64_t>(block_rows * row_bytes, sizeof(BlockEntry));
      for (const std::uint64_t limit : {smallest, 2 * smallest + 1, 5 * smallest, std::uint64_t{1} << 40}) {
        std::size_t block = 0;
        std::uint64_t row = 0;
        for (const TableSlice& slice : cut_tables(plan, TableNumbers::of(precision), device_allocating(limit))) {
          ASSERT_EQ(slice.first_block, block) << random.text();
          ASSERT_EQ(slice.first_row, row) << random.text();
          ASSERT_LT(slice.first_block, slice.last_block) << random.text();
          const std::uint64_t blocks = slice.last_block - slice.first_block;
          EXPECT_LE(whole_groups(slice.last_row - slice.first_row) * row_bytes, limit);
          EXPECT_LE(blocks * plan.function_count() * sizeof(SampleSpan), limit);
          EXPECT_LE(blocks * sizeof(BlockEntry), limit);
          EXPECT_EQ(plan.blocks[slice.first_block].table_row, row);
          block = slice.last_block;
          row = slice.last_row;
        }
        ASSERT_EQ(block, plan.blocks.size()) << random.text();
        ASSERT_EQ(row, plan.row_count()) << random.text();
      }
    }
  }
}

}  // namespace
}  // namespace nutik::test
