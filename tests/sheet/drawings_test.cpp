#include "sheet/drawings.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "mask/region.hpp"
#include "support/random_case.hpp"

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
