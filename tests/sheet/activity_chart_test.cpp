#include "sheet/activity_chart.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace nutik::sheet {
namespace {

// Columns of the chart in which there is ink of the curve's own colour.
std::pair<std::uint32_t, std::uint32_t> inked_columns(const Picture& chart) {
  std::pair<std::uint32_t, std::uint32_t> columns{~0u, 0};
  for (std::uint32_t y = 0; y < chart.shape.height; ++y) {
    for (std::uint32_t x = 0; x < chart.shape.width; ++x) {
      const auto codes =
          chart.values<std::uint8_t>().subspan((std::size_t{y} * chart.shape.width + x) * 3, 3);
      if (codes[0] != 0x9e || codes[1] != 0xca || codes[2] != 0xe9) continue;  // the area under the curve
      columns = {std::min(columns.first, x), std::max(columns.second, x)};
    }
  }
  return columns;
}

TEST(ActivityChart, ShowsChangesWhereTheyHappen) {
  // Only the samples of the second quarter change; the axis runs from column 80 to 1170.
  for (const std::size_t count : {std::size_t{40}, std::size_t{40'000}}) {
    std::vector<std::uint64_t> changes(count, 0);
    std::fill(changes.begin() + static_cast<std::ptrdiff_t>(count / 4),
              changes.begin() + static_cast<std::ptrdiff_t>(count / 2), 30u);
    const Timeline timeline = Timeline::constant({100, 1}, Timeline::kFullShutter, count);
    const Picture chart = activity_chart("clip", timeline, changes, 100, std::nullopt);
    const auto [first, last] = inked_columns(chart);
    EXPECT_NEAR(first, 80 + 1090 * 0.25, 3.0) << count;
    EXPECT_NEAR(last, 80 + 1090 * 0.5, 3.0) << count;
  }
}

TEST(ActivityChart, IsDrawnWhereNothingChanges) {
  const Timeline timeline = Timeline::constant({100, 1}, Timeline::kFullShutter, 3);
  const Picture chart = activity_chart("clip", timeline, std::vector<std::uint64_t>(3, 0), 100, std::nullopt);
  EXPECT_EQ(inked_columns(chart).first, ~0u);
}

}  // namespace
}  // namespace nutik::sheet
