// Masks between two key frames, in pixels counted by hand.
#include "mask/mask_between.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

// The first pixels of a row have the value 255.
Mask first_pixels(std::uint32_t count, std::uint32_t width = 10) {
  Mask mask = Mask::uniform(width, 1, 0);
  for (std::uint32_t i = 0; i < count; ++i) mask.tags[i] = 255;
  return mask;
}

Mask between(const Mask& a, const Mask& b, MaskBlend blend, std::uint32_t way) {
  return mask_between(a, "a.pgm", b, "b.pgm", blend, way);
}

// The edge lies behind pixel 4 and then behind pixel 8.
TEST(MaskBetween, ByDistanceMovesTheEdge) {
  const Mask a = first_pixels(4), b = first_pixels(8);
  EXPECT_EQ(between(a, b, MaskBlend::distance, 0), a);
  EXPECT_EQ(between(a, b, MaskBlend::distance, kWholeWay / 4), first_pixels(5));
  EXPECT_EQ(between(a, b, MaskBlend::distance, kWholeWay / 2), first_pixels(6));
  EXPECT_EQ(between(b, a, MaskBlend::distance, kWholeWay / 4), first_pixels(7));
  EXPECT_EQ(between(a, b, MaskBlend::distance, kWholeWay), b);
  // Half a pixel of the way: the edge runs through the middle of pixel 4, and the lowest value has it.
  EXPECT_EQ(between(a, b, MaskBlend::distance, kWholeWay / 8), first_pixels(4));
  EXPECT_EQ(between(a, b, MaskBlend::distance, kWholeWay / 8 + 1), first_pixels(5));
}

// A square of 9 x 9 pixels that moves by two to the right: half way it has moved by one. The edge then runs through the
// middle of its corners, which the lowest value has.
TEST(MaskBetween, ByDistanceMovesAShapeThatIsNear) {
  const auto square_at = [](std::uint32_t left) {
    Mask mask = Mask::uniform(40, 20, 7);
    for (std::uint32_t y = 6; y < 15; ++y) {
      for (std::uint32_t x = left; x < left + 9; ++x) mask.tags[y * 40 + x] = 64;
    }
    return mask;
  };
  Mask middle = square_at(11);
  for (const std::uint32_t y : {6u, 14u}) {
    for (const std::uint32_t x : {11u, 19u}) middle.tags[y * 40 + x] = 7;
  }
  EXPECT_EQ(between(square_at(10), square_at(12), MaskBlend::distance, kWholeWay / 2), middle);
}

TEST(MaskBetween, ByAlphaGivesEachPixelSharesOfBoth) {
  const Mask mask = between(first_pixels(4), first_pixels(8), MaskBlend::alpha, 3 * kWholeWay / 8);
  EXPECT_EQ(mask.mixed.pixels().size(), 4u);
  for (const std::uint64_t pixel : {4u, 7u}) {
    // 5/8 of 65535 are 40959.375 and 3/8 are 24575.625, which lost more when both were rounded down.
    const auto shares = mask.mixed.of(pixel);
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_EQ(shares[0], (Share{0, 40'959}));
    EXPECT_EQ(shares[1], (Share{255, 24'576}));
    EXPECT_EQ(mask.tags[pixel], 0);
  }
  EXPECT_EQ(mask.tags[3], 255);
  EXPECT_TRUE(mask.mixed.of(3).empty());
  EXPECT_EQ(between(first_pixels(4), first_pixels(8), MaskBlend::alpha, 0), first_pixels(4));
}

TEST(MaskBetween, ByAlphaMixesWhatIsMixed) {
  const Mask soft = between(first_pixels(0), first_pixels(10), MaskBlend::alpha, kWholeWay / 2);
  const Mask mask = between(soft, first_pixels(10), MaskBlend::alpha, kWholeWay / 2);
  // The soft one has 32768 of M0 and 32767 of M255: of equal losses the lowest value gets the rest.
  EXPECT_EQ(soft.mixed.of(0)[0], (Share{0, 32'768}));
  EXPECT_EQ(mask.mixed.of(0)[0], (Share{0, 16'384}));
  EXPECT_EQ(mask.mixed.of(0)[1], (Share{255, 49'151}));
}

TEST(MaskBetween, RefusesMasksThatDoNotBlend) {
  const auto message = [](const Mask& a, const Mask& b, MaskBlend blend) {
    return message_of<InputError>([&] { return between(a, b, blend, 1); });
  };
  EXPECT_EQ(message(first_pixels(4), first_pixels(4, 12), MaskBlend::alpha),
            "a.pgm has 10 x 1 pixels and b.pgm has 12 x 1; masks of key frames have one size");
  EXPECT_EQ(message(first_pixels(0), first_pixels(4), MaskBlend::distance),
            "mask value 255 is in b.pgm and not in a.pgm: by distance a region needs a place in both; paint a "
            "few pixels of it, or blend by alpha");
  const Mask soft = between(first_pixels(4), first_pixels(8), MaskBlend::alpha, 5);
  EXPECT_EQ(message(first_pixels(4), soft, MaskBlend::distance),
            "b.pgm is a soft mask, whose regions have no edges that could move; blend by alpha");
}

}  // namespace
}  // namespace nutik::test
