#include "sheet/thumbnail.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_case.hpp"

namespace nutik::sheet {
namespace {

Picture grey(std::uint32_t width, std::uint32_t height, const std::vector<std::uint8_t>& codes) {
  Picture picture({width, height, 1}, ValueType::code8, 255);
  std::copy(codes.begin(), codes.end(), picture.values<std::uint8_t>().begin());
  return picture;
}

Picture linear(std::uint32_t width, std::uint32_t height, const std::vector<std::uint8_t>& codes) {
  Picture picture = grey(width, height, codes);
  picture.transfer = Transfer::linear();
  return picture;
}

std::vector<int> codes_of(const Picture& picture) {
  const auto codes = picture.values<std::uint8_t>();
  return {codes.begin(), codes.end()};
}

TEST(Thumbnail, OfTheSameSizeIsThePicture) {
  std::vector<std::uint8_t> codes(256);
  for (std::size_t i = 0; i < 256; ++i) codes[i] = static_cast<std::uint8_t>(i);
  const Picture picture = grey(16, 16, codes);
  EXPECT_EQ(thumbnail(picture, 16, 16).bytes, picture.bytes);
}

TEST(Thumbnail, MeansLightAndNotCodes) {
  // Half the light of white is code 188 in sRGB, not 128.
  EXPECT_EQ(codes_of(thumbnail(grey(2, 2, {0, 255, 255, 0}), 1, 1)), (std::vector<int>{188}));
  // Linear codes are light themselves; the thumbnail is sRGB all the same.
  EXPECT_EQ(codes_of(thumbnail(linear(2, 1, {0, 255}), 2, 1)), (std::vector<int>{0, 255}));
  EXPECT_EQ(codes_of(thumbnail(linear(2, 1, {0, 255}), 1, 1)), (std::vector<int>{188}));
}

TEST(Thumbnail, SharesPixelsThatItCuts) {
  // Three pixels on two: each half has one whole pixel and half of the middle one, whose light is 1.
  const Transfer srgb = Transfer::srgb();
  const int third = static_cast<int>(std::lround(255 * srgb.fraction_of(1.0 / 3)));
  EXPECT_EQ(codes_of(thumbnail(grey(3, 1, {0, 255, 0}), 2, 1)), (std::vector<int>{third, third}));
  EXPECT_EQ(codes_of(thumbnail(grey(2, 1, {7, 9}), 4, 2)), (std::vector<int>{7, 7, 9, 9, 7, 7, 9, 9}));
}

TEST(Thumbnail, KeepsChannelsAndDepths) {
  Picture deep({2, 1, 3}, ValueType::code16, 4095);
  const std::uint16_t codes[] = {4095, 0, 0, 0, 0, 4095};
  std::copy_n(codes, 6, deep.values<std::uint16_t>().begin());
  EXPECT_EQ(codes_of(thumbnail(deep, 1, 1)), (std::vector<int>{188, 0, 188}));
}

TEST(Thumbnail, TakesCodesAboveWhiteForWhite) {
  Picture deep({2, 1, 1}, ValueType::code16, 1023);
  deep.values<std::uint16_t>()[0] = 65'535;
  deep.values<std::uint16_t>()[1] = 1024;
  EXPECT_EQ(codes_of(thumbnail(deep, 2, 1)), (std::vector<int>{255, 255}));
}

TEST(Thumbnail, KeepsTheMeanLightOfAnyPicture) {
  test::Random random(11);
  for (int i = 0; i < 50; ++i) {
    const auto width = static_cast<std::uint32_t>(random.whole(1, 60));
    const auto height = static_cast<std::uint32_t>(random.whole(1, 60));
    std::vector<std::uint8_t> codes(std::size_t{width} * height);
    double light = 0.0;
    const Transfer srgb = Transfer::srgb();
    for (std::uint8_t& code : codes) {
      code = static_cast<std::uint8_t>(random.whole(0, 255));
      light += srgb.light_of(code / 255.0) / static_cast<double>(codes.size());
    }
    const Picture small =
        thumbnail(grey(width, height, codes), static_cast<std::uint32_t>(random.whole(1, width)),
                  static_cast<std::uint32_t>(random.whole(1, height)));
    double mean = 0.0;
    for (const int code : codes_of(small)) {
      mean += srgb.light_of(code / 255.0) / static_cast<double>(small.shape.pixel_count());
    }
    // Each pixel is rounded by half a code at most, where sRGB is steepest 2.3 / 255 of light.
    EXPECT_NEAR(mean, light, 0.5 * 2.3 / 255);
  }
}

TEST(Thumbnail, FitsIntoASquareAndIsNeverLarger) {
  const auto size = [](const Picture& picture) { return std::pair(picture.shape.width, picture.shape.height); };
  const Picture wide = grey(8, 4, std::vector<std::uint8_t>(32, 9));
  EXPECT_EQ(size(fitted_thumbnail(wide, wide.shape, 4)), std::pair(4u, 2u));
  EXPECT_EQ(size(fitted_thumbnail(wide, wide.shape, 100)), std::pair(8u, 4u));
  EXPECT_EQ(size(fitted_thumbnail(wide, {8, 8, 1}, 6)), std::pair(6u, 6u)) << "pixels twice as high as wide";
  EXPECT_EQ(size(fitted_thumbnail(grey(64, 1, std::vector<std::uint8_t>(64, 9)), {64, 1, 1}, 4)), std::pair(4u, 1u))
      << "no side is nothing";
}

}  // namespace
}  // namespace nutik::sheet
