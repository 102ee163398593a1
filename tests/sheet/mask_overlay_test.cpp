#include "sheet/mask_overlay.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "mask/region.hpp"

namespace nutik::sheet {
namespace {

using Rgb = std::array<int, 3>;

Rgb at(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const auto codes =
      picture.values<std::uint8_t>().subspan((std::size_t{y} * picture.shape.width + x) * 3, 3);
  return {codes[0], codes[1], codes[2]};
}

Picture grey(std::uint32_t width, std::uint32_t height, int code) {
  Picture picture({width, height, 1}, ValueType::code8, 255);
  std::fill(picture.bytes.begin(), picture.bytes.end(), std::byte(code));
  return picture;
}

TEST(MaskOverlay, ShowsEveryTagInAColourAndTagZeroAsItIs) {
  Mask mask = Mask::uniform(600, 300, 0);
  for (std::uint8_t i = 0; i < 6; ++i) {
    paint(mask, rectangle(600, 300, {i * 100.0, 100}, 100, 100), static_cast<std::uint8_t>(40 * (i + 1)));
  }
  const Picture overlay = mask_overlay(mask, grey(600, 300, 77));
  EXPECT_EQ(overlay.shape.width, 600u);
  EXPECT_GT(overlay.shape.height, 300u);  // the legend
  for (const std::uint32_t x : {0u, 50u, 599u}) EXPECT_EQ(at(overlay, x, 50), (Rgb{77, 77, 77}));
  EXPECT_EQ(at(overlay, 0, 0), (Rgb{77, 77, 77}));
  std::set<Rgb> colours;
  for (std::uint32_t i = 0; i < 6; ++i) {
    colours.insert(at(overlay, i * 100 + 20, 120));
    EXPECT_NE(at(overlay, i * 100 + 20, 100), at(overlay, i * 100 + 20, 101)) << "no border round " << i;
  }
  EXPECT_EQ(colours.size(), 6u);
  // Half the colour, half the grey: 0x0072b2 over 77, rounded half up.
  EXPECT_EQ(at(overlay, 20, 120), (Rgb{39, 96, 128}));
}

TEST(MaskOverlay, EnlargesASmallPictureAndTakesAllTags) {
  Mask mask = Mask::uniform(16, 16, 0);
  for (std::size_t pixel = 0; pixel < 256; ++pixel) mask.tags[pixel] = static_cast<std::uint8_t>(pixel);
  const Picture overlay = mask_overlay(mask, grey(16, 16, 200));
  EXPECT_EQ(overlay.shape.width, 480u);
  EXPECT_EQ(at(overlay, 5, 5), (Rgb{200, 200, 200}));  // tag 0, thirty pixels wide
  const Picture plain = mask_overlay(Mask::uniform(16, 16, 9), grey(16, 16, 0));
  EXPECT_EQ(at(plain, 3, 3), (Rgb{0, 57, 89}));
}

TEST(MaskOverlay, DrawsPixelsAsLongAsTheyAreShown) {
  Mask mask = Mask::uniform(720, 480, 0);
  paint(mask, rectangle(720, 480, {0, 0}, 360, 480), 9);
  Picture picture = grey(720, 480, 77);
  picture.pixel_aspect = {32, 27};
  const Picture wide = mask_overlay(mask, picture);
  EXPECT_EQ(wide.shape.width, 853u);  // 720 * 32 / 27
  EXPECT_NE(at(wide, 420, 240), (Rgb{77, 77, 77}));
  EXPECT_EQ(at(wide, 430, 240), (Rgb{77, 77, 77}));
  picture.pixel_aspect = {1, 2};
  const Picture high = mask_overlay(mask, picture);
  EXPECT_EQ(high.shape.width, 720u);
  EXPECT_GT(high.shape.height, 960u);
  EXPECT_EQ(at(high, 400, 950), (Rgb{77, 77, 77}));
}

}  // namespace
}  // namespace nutik::sheet
