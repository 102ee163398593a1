#include "mask/region.hpp"

#include <gtest/gtest.h>

#include <string>

#include "mask/distance.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// `#` inside, `.` outside, a line for each row.
Region drawn(const std::vector<std::string>& rows) {
  Region region =
      Region::none(static_cast<std::uint32_t>(rows.front().size()), static_cast<std::uint32_t>(rows.size()));
  std::size_t pixel = 0;
  for (const std::string& row : rows) {
    for (const char c : row) region.inside[pixel++] = c == '#' ? 1 : 0;
  }
  return region;
}

std::string text(const Region& region) {
  std::string text;
  for (std::size_t pixel = 0; pixel < region.inside.size(); ++pixel) {
    text += region.inside[pixel] != 0 ? '#' : '.';
    if ((pixel + 1) % region.width == 0) text += '\n';
  }
  return text;
}

#define EXPECT_REGION(region, ...) EXPECT_EQ(text(region), text(drawn(__VA_ARGS__)))

Region random_region(Random& random) {
  Region region = Region::none(static_cast<std::uint32_t>(random.whole(1, 24)),
                               static_cast<std::uint32_t>(random.whole(1, 24)));
  const double share = random.pick<double>({0.0, 0.01, 0.2, 0.5, 0.8, 1.0});
  for (std::uint8_t& inside : region.inside) inside = random.chance(share) ? 1 : 0;
  return region;
}

TEST(Shape, RectangleCoversWholePixels) {
  EXPECT_REGION(rectangle(5, 3, {1, 1}, 2, 1), {".....", ".##..", "....."});
  EXPECT_REGION(rectangle(5, 3, {-3, -9}, 5, 10), {"##...", ".....", "....."});
  EXPECT_REGION(rectangle(5, 1, {0.6, 0}, 1.0, 1), {".#..."});  // holds the centre 1.5
  EXPECT_EQ(rectangle(5, 3, {9, 9}, 2, 2).pixel_count(), 0u);
}

TEST(Shape, EllipseHoldsTheCentresWithin) {
  EXPECT_REGION(ellipse(5, 5, {2.5, 2.5}, 2.2, 1.2), {".....", ".###.", "#####", ".###.", "....."});
  // 1000² π/4 within a pixel on each side of every row
  const double area = static_cast<double>(ellipse(1000, 1000, {500, 500}, 500, 500).pixel_count());
  EXPECT_NEAR(area, 785'398.2, 2000.0);
}

TEST(Shape, PolygonIsEvenOddAndCountsCornersOnce) {
  const std::vector<Point> triangle{{0, 0}, {4, 0}, {0, 4}};
  EXPECT_REGION(polygon(5, 4, triangle), {"###..", "##...", "#....", "....."});
  // A corner on a row of centres neither opens nor closes twice.
  const std::vector<Point> kite{{2.5, 0}, {5, 1.5}, {2.5, 3}, {0, 1.5}};
  EXPECT_REGION(polygon(5, 3, kite), {"..#..", "#####", "..#.."});
  const std::vector<Point> twice{{0, 0}, {6, 0}, {6, 3}, {0, 3}, {0, 0},
                                 {2, 1}, {2, 2}, {4, 2}, {4, 1}, {2, 1}};
  EXPECT_REGION(polygon(6, 3, twice), {"######", "##..##", "######"});
  EXPECT_THROW(static_cast<void>(polygon(5, 5, std::vector<Point>{{0, 0}, {1, 1}})), std::logic_error);
}

TEST(Shape, PolygonOfARectangleIsTheRectangle) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const double x = random.real(-3, 20), y = random.real(-3, 20), w = random.real(0, 20),
                 h = random.real(0, 20);
    const std::vector<Point> corners{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
    ASSERT_EQ(text(polygon(17, 13, corners)), text(rectangle(17, 13, {x, y}, w, h))) << "seed " << seed;
  }
}

TEST(Region, LargestPartHangsTogetherOverCorners) {
  const Region parts = drawn({"##...#", "....#.", "##.#..", "......"});
  EXPECT_REGION(largest_part(parts), {".....#", "....#.", "...#..", "......"});
  EXPECT_REGION(largest_part(drawn({"#.#"})), {"#.."});  // the first of equals
  EXPECT_EQ(largest_part(Region::none(3, 2)).pixel_count(), 0u);
  EXPECT_REGION(with_holes_filled(drawn({".####.", ".#..##", ".#.#.#", ".#####"})),
                {".####.", ".#####", ".#####", ".#####"});
  EXPECT_REGION(with_holes_filled(drawn({"###", "#.#", "##."})), {"###", "#.#", "##."});
  EXPECT_EQ(largest_part(Region::all(3, 2)).pixel_count(), 6u);
}

TEST(Region, IsPaintedOverWhatWasThere) {
  Mask mask = Mask::uniform(3, 1, 7);
  paint(mask, drawn({".##"}), 128);
  paint(mask, drawn({"..#"}), 255);
  EXPECT_EQ(mask.tags, (std::vector<std::uint8_t>{7, 128, 255}));
}

TEST(Distance, IsThatToTheNearestPixelInside) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const Region region = random_region(random);
    const std::vector<std::uint64_t> distances = squared_distances(region);
    for (std::size_t pixel = 0; pixel < distances.size(); ++pixel) {
      std::uint64_t nearest = kFarAway;
      for (std::size_t other = 0; other < distances.size(); ++other) {
        if (region.inside[other] == 0) continue;
        const auto dx =
            static_cast<std::int64_t>(pixel % region.width) - static_cast<std::int64_t>(other % region.width);
        const auto dy =
            static_cast<std::int64_t>(pixel / region.width) - static_cast<std::int64_t>(other / region.width);
        nearest = std::min(nearest, static_cast<std::uint64_t>(dx * dx + dy * dy));
      }
      ASSERT_EQ(distances[pixel], nearest) << "seed " << seed << ", pixel " << pixel << "\n" << text(region);
    }
  }
}

TEST(Distance, GrowsAndShrinksByDiscs) {
  const Region dot = drawn({".......", ".......", ".......", "...#...", ".......", ".......", "......."});
  EXPECT_REGION(grown(dot, 2), {".......", "...#...", "..###..", ".#####.", "..###..", "...#...", "......."});
  EXPECT_REGION(shrunk(grown(dot, 2), 2),
                {".......", ".......", ".......", "...#...", ".......", ".......", "......."});
  EXPECT_EQ(grown(dot, 0), dot);
  EXPECT_EQ(shrunk(dot, 0), dot);
  EXPECT_EQ(shrunk(dot, 1).pixel_count(), 0u);
  // Nothing comes from beyond the border.
  EXPECT_EQ(shrunk(Region::all(4, 3), 2).pixel_count(), 12u);
  EXPECT_EQ(grown(Region::none(4, 3), 2).pixel_count(), 0u);
}

TEST(Distance, SmoothingTakesSpecksAndFillsHoles) {
  Region region = rectangle(30, 20, {8, 4}, 14, 12);
  const Region smooth = smoothed(region, 2);
  region.inside[1 * 30 + 2] = 1;    // a speck
  region.inside[10 * 30 + 15] = 0;  // a hole
  EXPECT_EQ(text(smoothed(region, 2)), text(smooth));
  EXPECT_EQ(smooth.inside[10 * 30 + 15], 1);
  EXPECT_EQ(smooth.inside[1 * 30 + 2], 0);
}

}  // namespace
}  // namespace nutik::test
