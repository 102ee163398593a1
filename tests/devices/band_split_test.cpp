// How rows of a picture are shared out among devices.
#include "opencl/band_split.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "imev/tile.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

std::vector<std::uint32_t> heights(const std::vector<Rectangle>& bands) {
  std::vector<std::uint32_t> heights;
  for (const Rectangle& band : bands) heights.push_back(band.height);
  return heights;
}

using Heights = std::vector<std::uint32_t>;

TEST(BandSplit, IsInProportionToSpeed) {
  EXPECT_EQ(heights(BandSplit(std::vector{1.0, 1.0}).cut({0, 0, 64, 80})), (Heights{40, 40}));
  EXPECT_EQ(heights(BandSplit(std::vector{30.0, 10.0}).cut({0, 0, 64, 80})), (Heights{64, 16}));
  EXPECT_EQ(heights(BandSplit(std::vector{1.0, 1.0, 2.0}).cut({0, 0, 64, 85})), (Heights{24, 24, 37}));
}

TEST(BandSplit, GivesDevicesNothingWhereThereAreFewerRowsOfTiles) {
  EXPECT_EQ(heights(BandSplit(std::vector{1.0, 1.0}).cut({0, 0, 64, 8})), (Heights{8, 0}));
  EXPECT_EQ(heights(BandSplit(std::vector{1.0, 1.0}).cut({3, 7, 1, 2})), (Heights{1, 1}));
  EXPECT_EQ(heights(BandSplit(std::vector{1.0, 1.0, 1.0}).cut({0, 0, 64, 16})), (Heights{8, 0, 8}));
}

// For any rectangle and any speeds.
TEST(BandSplit, HasEachRowOnceAndCutsWhereTilesEnd) {
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    std::vector<double> speeds(static_cast<std::size_t>(random.whole(1, 6)));
    for (double& speed : speeds) speed = random.real(0.01, 100.0);
    const Rectangle rectangle{
        static_cast<std::uint32_t>(random.whole(0, 40)), static_cast<std::uint32_t>(random.whole(0, 40)),
        static_cast<std::uint32_t>(random.whole(1, 40)), static_cast<std::uint32_t>(random.whole(1, 200))};
    const std::vector<Rectangle> bands = BandSplit(speeds).cut(rectangle);
    ASSERT_EQ(bands.size(), speeds.size());
    std::uint32_t y = rectangle.y;
    for (const Rectangle& band : bands) {
      ASSERT_EQ(band.x, rectangle.x);
      ASSERT_EQ(band.width, rectangle.width);
      ASSERT_EQ(band.y, y);
      y += band.height;
      ASSERT_TRUE(y % kTileSide == 0 || y == rectangle.y || y == rectangle.y + rectangle.height) << y;
    }
    ASSERT_EQ(y, rectangle.y + rectangle.height);
  }
}

TEST(BandSplit, StaysWhileDevicesAreDoneAtAboutTheSameTime) {
  BandSplit split(std::vector{1.0, 1.0});
  const auto bands = split.cut({0, 0, 64, 800});
  for (int k = 0; k < 100; ++k) split.took(bands, std::vector{1.0, 0.81});
  for (int k = 0; k < 100; ++k) split.took(bands, std::vector{0.001, 0.004});  // too short to tell
  EXPECT_EQ(split.cut({0, 0, 64, 800}), bands);
}

// One picture is a third longer than it would have to be: moving costs a half.
TEST(BandSplit, MovesWhenWaitingHasCostAsMuchAsMoving) {
  BandSplit split(std::vector{1.0, 1.0});
  const auto bands = split.cut({0, 0, 64, 800});
  split.took(bands, std::vector{1.0, 0.5});
  EXPECT_EQ(split.cut({0, 0, 64, 800}), bands);
  split.took(bands, std::vector{1.0, 0.5});
  EXPECT_EQ(heights(split.cut({0, 0, 64, 800})), (Heights{264, 536}));
  BandSplit far_off(std::vector{1.0, 1.0});
  far_off.took(bands, std::vector{1.0, 0.1});
  EXPECT_EQ(heights(far_off.cut({0, 0, 64, 800})), (Heights{72, 728}));
}

// One device is slower now, the other then, because others use it as well.
TEST(BandSplit, DoesNotRunAfterChance) {
  BandSplit split(std::vector{1.0, 1.0});
  const auto bands = split.cut({0, 0, 64, 800});
  for (int k = 0; k < 100; ++k) split.took(bands, k % 2 == 0 ? std::vector{1.0, 0.6} : std::vector{0.6, 1.0});
  EXPECT_EQ(split.cut({0, 0, 64, 800}), bands);
}

TEST(BandSplit, FollowsADeviceThatBecomesSlower) {
  BandSplit split(std::vector{1.0, 1.0});
  const auto bands = split.cut({0, 0, 64, 800});
  split.took(bands, std::vector{60.0, 60.0});  // while kernels are built
  for (int k = 0; k < 500; ++k) split.took(bands, std::vector{1.0, 1.0});
  for (int k = 0; k < 20; ++k) split.took(split.cut({0, 0, 64, 800}), std::vector{1.5, 1.0});
  EXPECT_LT(split.cut({0, 0, 64, 800}).front().height, 352u);
}

// Devices of any speeds, on pictures whose lower part costs more, are all done at about the same time after some
// pictures; and from then on nothing moves.
TEST(BandSplit, FindsTheBalance) {
  Random random(11);
  for (int k = 0; k < 200; ++k) {
    std::vector<double> speeds(static_cast<std::size_t>(random.whole(2, 4)));
    for (double& speed : speeds) speed = random.real(1.0, 8.0);
    const double more = random.real(0.0, 3.0);
    BandSplit split(std::vector<double>(speeds.size(), 1.0));
    std::vector<Rectangle> bands;
    std::vector<double> seconds;
    int moved = 0;
    for (int picture = 0; picture < 60; ++picture) {
      if (const auto before = std::exchange(bands, split.cut({0, 0, 64, 4000})); bands != before)
        moved = picture;
      seconds.clear();
      for (std::size_t i = 0; i < bands.size(); ++i) {
        const double middle = bands[i].y + bands[i].height / 2.0;
        seconds.push_back(bands[i].height * (1.0 + more * middle / 4000.0) / speeds[i]);
      }
      split.took(bands, seconds);
    }
    const auto [least, most] = std::ranges::minmax(seconds);
    ASSERT_GE(least, 0.8 * most) << k;
    ASSERT_LT(moved, 40) << k;
  }
}

TEST(BandSplit, DoesNotForgetASlowDevice) {
  BandSplit split(std::vector{1.0, 1.0});
  for (int k = 0; k < 10; ++k) split.took(split.cut({0, 0, 64, 8000}), std::vector{0.01, 1000.0});
  EXPECT_GT(split.cut({0, 0, 64, 8000}).back().height, 0u);
  const auto shares = split.shares();
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-12);
}

}  // namespace
}  // namespace nutik::test
