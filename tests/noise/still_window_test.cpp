// What a window says of pixels, beside sums over their codes that need no noise.
#include "noise/still_window.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace nutik {
namespace {

// Stripes that stand still but for three pixels: one that goes up and down by 2 codes, and with it its neighbours to
// the right and below, where there are any.
TEST(StillWindow, SaysOfEveryPixelWhatItStrays) {
  const CaptureFormat format{.shape = {21, 13, 1}};
  for (const std::uint32_t lively : {0u, 20u, 13u * 21 - 1, 100u}) {
    StillWindow window(format);
    while (!window.is_full()) {
      std::vector<std::byte> raster(format.sample_bytes());
      for (std::size_t i = 0; i < raster.size(); ++i)
        raster[i] = static_cast<std::byte>(i % 2 == 0 ? 100 : 140);
      const int sign = window.sample_count() % 2 == 0 ? 2 : -2;
      for (const std::size_t pixel : {std::size_t{lively}, std::size_t{lively} + kNeighbourPixels,
                                      std::size_t{lively} + kNeighbourPixels * format.shape.width}) {
        if (pixel < raster.size()) raster[pixel] = static_cast<std::byte>(120 + sign);
      }
      window.add(raster);
    }
    const std::vector<PixelNoise> noise = window.measure(0);
    ASSERT_EQ(noise.size(), StillWindow::pixel_count(format.shape));
    ASSERT_EQ(noise.size(), format.shape.pixel_count());
    for (std::size_t i = 0; i < noise.size(); ++i) {
      const auto x = static_cast<std::uint32_t>(i) % format.shape.width,
                 y = static_cast<std::uint32_t>(i) / format.shape.width;
      const bool is_lively = i == lively || i == lively + kNeighbourPixels ||
                             i == lively + kNeighbourPixels * format.shape.width;
      // Second differences of ±2 are ±8, and of independent noise have six times its variance.
      const float variance = 64.0F / 6;
      EXPECT_FLOAT_EQ(noise[i].code, is_lively ? 120 : i % 2 == 0 ? 100 : 140) << x << "," << y;
      EXPECT_FLOAT_EQ(noise[i].variance, is_lively ? variance : 0) << x << "," << y;
      const bool has_right = x + kNeighbourPixels < format.shape.width,
                 has_below = y + kNeighbourPixels < format.shape.height;
      EXPECT_FLOAT_EQ(noise[i].beside, i == lively && has_right ? variance : 0) << x << "," << y;
      EXPECT_FLOAT_EQ(noise[i].below, i == lively && has_below ? variance : 0) << x << "," << y;
      EXPECT_EQ(noise[i].place, 2 * (y % 2) + x % 2);
    }
  }
}

}  // namespace
}  // namespace nutik
