// What pictures of a moving camera saw, beside each pixel's own place in them.
#include "align/seen_area.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace nutik {
namespace {

constexpr Shape kShape{23, 17, 1};
constexpr double kOfRounding = 1e-4;  // pixels from the border within which a place may count or not

// By how much a pixel lies inside of what a picture saw: negative outside, and behind the camera.
double depth_inside(const Warp& warp, std::uint32_t x, std::uint32_t y) {
  if (warp.m[6] * x + warp.m[7] * y + warp.m[8] <= 0) return -1;
  const Place place = warp.at(x, y);
  return kSeenBeyond + std::min({place.x, place.y, kShape.width - 1 - place.x, kShape.height - 1 - place.y});
}

// Turned, shifted, and seen from another side, some so far that the horizon is in the picture.
Warp random_warp(std::mt19937& random) {
  const auto within = [&](double most) { return std::uniform_real_distribution(-most, most)(random); };
  const double angle = within(0.6), scale = 1 + within(0.4), far = random() % 4 == 0 ? 0.2 : 0.02;
  return {{scale * std::cos(angle), -scale * std::sin(angle), within(8), scale * std::sin(angle),
           scale * std::cos(angle), within(8), within(far), within(far), 1}};
}

TEST(SeenArea, OfARowIsWhatHasItsPlaceInThePicture) {
  std::mt19937 random(1);
  std::uint64_t seen = 0, unseen = 0;
  for (int repetition = 0; repetition < 2000; ++repetition) {
    const Warp warp = random_warp(random);
    for (std::uint32_t y = 0; y < kShape.height; ++y) {
      const PixelSpan span = seen_span(warp, kShape, y);
      for (std::uint32_t x = 0; x < kShape.width; ++x) {
        const double depth = depth_inside(warp, x, y);
        if (std::fabs(depth) < kOfRounding) continue;
        ASSERT_EQ(x >= span.first && x<span.end, depth> 0)
            << "pixel " << x << "," << y << " of warp " << repetition << " lies " << depth
            << " pixels inside";
        ++(depth > 0 ? seen : unseen);
      }
    }
  }
  EXPECT_GT(seen, 100'000u);
  EXPECT_GT(unseen, 100'000u);
}

// Which registering finds a little beside where it is.
TEST(SeenArea, ACameraThatRestsSawItsWholePicture) {
  for (const double found : {-0.03, 0.0, 0.03}) {
    const Warp warp{{1, 1e-4, found, -1e-4, 1, -found, 0, 0, 1}};
    for (std::uint32_t y = 0; y < kShape.height; ++y) {
      const PixelSpan span = seen_span(warp, kShape, y);
      EXPECT_EQ(span.first, 0u) << found;
      EXPECT_EQ(span.end, kShape.width) << found;
    }
  }
}

}  // namespace
}  // namespace nutik
