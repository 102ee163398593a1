#include "sheet/activity_chart.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace nutik::sheet {
namespace {

TEST(ActivityMap, IsBlackWhereNothingChangesAndWhiteWhereMostDoes) {
  const Picture map = activity_map({3, 1, 3}, std::vector<std::uint64_t>{0, 168, 84});
  const auto codes = map.values<std::uint8_t>();
  EXPECT_EQ(map.shape.channels, 1u);
  EXPECT_EQ(codes[0], 0);
  EXPECT_EQ(codes[1], 255);
  EXPECT_EQ(codes[2], 188);  // half the light
  const Picture still = activity_map({2, 1, 1}, std::vector<std::uint64_t>{0, 0});
  EXPECT_EQ(still.values<std::uint8_t>()[1], 0);
}

}  // namespace
}  // namespace nutik::sheet
