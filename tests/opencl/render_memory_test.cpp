// How a render's memory is shared out.
#include "opencl/render_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "capture/memory_needs.hpp"
#include "opencl/band_split.hpp"
#include "opencl/kernel_numbers.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// All tables where there is room for them; else a quarter of what is left, and those of the longest block at least.
TEST(RenderMemory, HoldsTheTablesOfABlockAndMoreWhereThereIsRoom) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    const MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    if (plan.blocks.empty()) continue;
    std::uint64_t rows = 0;
    for (const PlannedBlock& planned : plan.blocks) rows = std::max(rows, planned.row_count());
    const Precision precision = Precision::double_;
    const auto slice_of = [&](std::uint64_t allowed) {
      return memory_for_render(allowed, plan, capture, capture.format().shape, ValueType::light32, precision)
          .slice_bytes;
    };
    const std::uint64_t row_bytes = plan.function_count() * weight_bytes(precision);
    EXPECT_EQ(slice_of(1ull << 30), plan.row_count() * row_bytes);
    // The least that does not throw.
    std::uint64_t least = 0, enough = 1ull << 30;
    while (enough - least > 1) {
      const std::uint64_t allowed = least + (enough - least) / 2;
      try {
        (void)slice_of(allowed);
        enough = allowed;
      } catch (const MemoryTooLittle&) {
        least = allowed;
      }
    }
    EXPECT_EQ(slice_of(enough), rows * row_bytes);
  }
}

// However fast devices are, and whether they all have a band: a film that began does not end for want of memory.
TEST(RenderMemory, DoesForAnyBandsOfAPicture) {
  Random draw(7);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    const MemoryCapture capture = random.encode();
    const std::uint32_t channels = capture.format().shape.channels;
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    // Up to where the picture is developed in parts. Only sizes are computed: it need not be the capture's.
    for (const Rectangle& picture : {Rectangle{0, 0, 5, 8}, Rectangle{2, 5, 19, 40}, Rectangle{0, 3, 2000, 3001}}) {
      const std::size_t devices = 2 + seed % 3;
      std::uint64_t least = 0;
      for (int k = 0; k < 20; ++k) {
        std::vector<double> speeds(devices);
        for (double& speed : speeds) speed = k == 0 ? 1.0 : draw.chance(0.3) ? 1e-6 : draw.real(0.01, 1.0);
        const std::vector<Rectangle> bands = BandSplit(speeds).cut(picture);
        const auto shares_of = [&](std::uint64_t allowed) {
          return memory_of_bands(allowed, plan, capture, bands, ValueType::code16, Precision::fixed);
        };
        std::uint64_t named = 0;
        try {
          (void)shares_of(1);
        } catch (const MemoryTooLittle& error) {
          named = error.min_bytes();
        }
        if (least == 0) least = named;
        ASSERT_EQ(named, least);
        EXPECT_THROW((void)shares_of(least - 1), MemoryTooLittle);
        for (const std::uint64_t allowed : {least, 2 * least + 1}) {
          const std::vector<std::uint64_t> shares = shares_of(allowed);
          for (std::size_t i = 0; i < devices; ++i) {
            const Shape shape{picture.width, bands[i].height, channels};
            EXPECT_GE(shares[i],
                      least_memory(plan, capture, shape, ValueType::code16, Precision::fixed).needs.bytes());
          }
          const std::uint64_t whole = std::uint64_t{picture.width} * picture.height * channels * 2;
          EXPECT_LE(std::accumulate(shares.begin(), shares.end(), whole), allowed);
        }
      }
    }
  }
}

}  // namespace
}  // namespace nutik::test
