// How a render's memory is shared out.
#include "opencl/render_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "capture/memory_needs.hpp"
#include "opencl/kernel_tables.hpp"
#include "support/random_case.hpp"

namespace nutik {
namespace {

// All tables where there is room for them; else a quarter of what is left, and those of the longest block at least.
TEST(RenderMemory, HoldsTheTablesOfABlockAndMoreWhereThereIsRoom) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const test::RandomCase random(seed);
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

}  // namespace
}  // namespace nutik
