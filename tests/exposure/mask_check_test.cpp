// Each flaw of a mask: one that has it, and one that has not.
#include "exposure/mask_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

constexpr std::array<bool, kMaskValues> kNoneMapped{};

std::array<bool, kMaskValues> mapped(std::initializer_list<std::uint8_t> tags) {
  std::array<bool, kMaskValues> is_mapped{};
  for (const std::uint8_t tag : tags) is_mapped[tag] = true;
  return is_mapped;
}

void fill(Mask& mask, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
          std::uint8_t tag) {
  for (std::uint32_t row = y; row < y + height; ++row) {
    for (std::uint32_t column = x; column < x + width; ++column) {
      mask.tags[std::size_t{row} * mask.width + column] = tag;
    }
  }
}

// A disc of 200 in 40, its edge sharp or smoothed by the share of each pixel that it covers.
Mask disc(bool is_smooth) {
  Mask mask = Mask::uniform(160, 120, 40);
  constexpr int kParts = 8;
  for (std::uint32_t y = 0; y < mask.height; ++y) {
    for (std::uint32_t x = 0; x < mask.width; ++x) {
      int inside = 0;
      for (int part = 0; part < kParts * kParts; ++part) {
        const double dx = x + (part % kParts + 0.5) / kParts - 80.3;
        const double dy = y + (part / kParts + 0.5) / kParts - 60.1;
        inside += dx * dx + dy * dy < 35.0 * 35.0;
      }
      const double share = static_cast<double>(inside) / (kParts * kParts);
      const double value = is_smooth ? 40 + 160 * share : share >= 0.5 ? 200 : 40;
      mask.tags[std::size_t{y} * mask.width + x] = static_cast<std::uint8_t>(std::lround(value));
    }
  }
  return mask;
}

TEST(MaskCheck, SharpRegionsAreSilent) {
  for (const auto& is_mapped : {kNoneMapped, mapped({40, 200})}) {
    const MaskFlaws flaws = find_flaws(disc(false), is_mapped);
    EXPECT_TRUE(flaws.specks.empty());
    EXPECT_TRUE(flaws.blended.empty());
  }
  // A thick ring of a value between those on its sides was painted.
  Mask rings = Mask::uniform(200, 200, 0);
  fill(rings, 50, 50, 20, 20, 128);
  fill(rings, 53, 53, 14, 14, 255);
  EXPECT_TRUE(find_flaws(rings, kNoneMapped).blended.empty());
}

TEST(MaskCheck, SmoothedEdgesAreFound) {
  const Mask mask = disc(true);
  const auto counts = mask.pixels_per_tag();
  std::vector<int> wanted;
  for (int value = 0; value < 256; ++value) {
    if (value != 40 && value != 200 && counts[static_cast<std::size_t>(value)] > 0) wanted.push_back(value);
  }
  ASSERT_GT(wanted.size(), 20u);
  // Also where a function happens to be written for one of them.
  for (const auto& is_mapped : {kNoneMapped, mapped({40, 120, 200})}) {
    const MaskFlaws flaws = find_flaws(mask, is_mapped);
    std::vector<int> found;
    for (const BlendedValue& value : flaws.blended) {
      found.push_back(value.value);
      EXPECT_EQ(value.pixel_count, counts[value.value]);
      EXPECT_EQ(mask.tags[std::size_t{value.y} * mask.width + value.x], value.value);
    }
    // A pixel at the outermost of an edge may have no lower or no higher neighbour; most have both.
    EXPECT_GE(found.size() * 10, wanted.size() * 9);
    EXPECT_TRUE(flaws.specks.empty());
  }
}

TEST(MaskCheck, WhatJpegLeavesIsFoundUnlessItIsMapped) {
  Mask mask = Mask::uniform(160, 120, 40);
  Random random(5);
  // Rings of small errors round an edge.
  fill(mask, 60, 40, 40, 40, 200);
  for (std::uint32_t x = 60; x < 100; x += 2) {
    fill(mask, x, 38, 1, 1, static_cast<std::uint8_t>(random.whole(37, 39)));
  }
  const MaskFlaws flaws = find_flaws(mask, mapped({40, 200}));
  ASSERT_EQ(flaws.blended.size(), 3u);
  EXPECT_EQ(flaws.blended[0].value, 37);
  EXPECT_EQ(flaws.blended[2].value, 39);
  const MaskFlaws meant = find_flaws(mask, mapped({37, 38, 39, 40, 200}));
  EXPECT_TRUE(meant.blended.empty());
}

TEST(MaskCheck, SpecksHaveTagPlaceAndSize) {
  Mask mask = Mask::uniform(160, 120, 0);  // 19 200 pixels: up to 16 are a speck
  fill(mask, 20, 20, 50, 50, 255);
  EXPECT_TRUE(find_flaws(mask, kNoneMapped).specks.empty());
  fill(mask, 100, 10, 4, 4, 255);   // one
  fill(mask, 130, 10, 17, 1, 255);  // too large for one
  fill(mask, 40, 40, 2, 1, 0);      // a hole is one of what is in it
  fill(mask, 42, 41, 1, 1, 0);      // joined at a corner
  const auto specks = find_flaws(mask, kNoneMapped).specks;
  ASSERT_EQ(specks.size(), 2u);
  EXPECT_EQ(specks[0].tag, 0);
  EXPECT_EQ(specks[0].x, 40u);
  EXPECT_EQ(specks[0].y, 40u);
  EXPECT_EQ(specks[0].pixel_count, 3u);
  EXPECT_EQ(specks[1].tag, 255);
  EXPECT_EQ(specks[1].x, 100u);
  EXPECT_EQ(specks[1].y, 10u);
  EXPECT_EQ(specks[1].pixel_count, 16u);
}

TEST(MaskCheck, InSmallMasksNothingIsTooSmall) {
  Mask mask = Mask::uniform(30, 30, 0);
  fill(mask, 3, 3, 1, 1, 9);
  EXPECT_TRUE(find_flaws(mask, kNoneMapped).specks.empty());
}

TEST(MaskCheck, Sizes) {
  const CaptureFormat capture{{640, 360, 3}};
  const auto mistake_of = [](const Mask& mask, const CaptureFormat& of) {
    return message_of<InputError>([&] { check_size(mask, of); });
  };
  const auto mistake = [&](std::uint32_t width, std::uint32_t height) {
    return mistake_of(Mask::uniform(width, height, 0), capture);
  };
  check_size(Mask::uniform(640, 360, 0), capture);
  EXPECT_EQ(mistake(360, 640), "the mask is 360 x 640 pixels, the capture 640 x 360; turn it by 90 degrees");
  EXPECT_EQ(mistake(1280, 720),
            "the mask is 1280 x 720 pixels, the capture 640 x 360; scale it to 640 x 360 without smoothing "
            "(nearest neighbour), which would make new values");
  expect_says(mistake(213, 120), "; scale it to 640 x 360");  // a third, rounded
  EXPECT_EQ(mistake_of(Mask::uniform(5, 5, 0), {{4, 4, 1}}).find("turn"), std::string::npos);
  expect_says(mistake(180, 320), "; turn it by 90 degrees and scale it to 640 x 360");
  Mask soft = Mask::uniform(1280, 720, 0);
  soft.mixed.add(0, std::vector<Share>{{0, 30000}, {1, 35535}});
  EXPECT_EQ(mistake_of(soft, capture),
            "the mask is 1280 x 720 pixels, the capture 640 x 360; scale it to 640 x 360");
  expect_says(mistake(640, 480), "; both must have the same size");
}

TEST(MaskCheck, TellsTheWayOutOfSizesThatTheProgramMakes) {
  CaptureFormat capture{{96, 64, 3}};
  const auto advice = [&](std::uint32_t width, std::uint32_t height) {
    return size_advice(width, height, capture).text;
  };
  EXPECT_EQ(advice(192, 128), "");
  EXPECT_EQ(advice(80, 100), "");
  expect_says(advice(90, 62), "`unseen hold`");
  expect_says(advice(120, 70), "(`crop`)");
  capture.pixel_aspect = {2, 1};
  expect_says(advice(192, 64), "`keep-pixels`");
}

TEST(MaskCheck, ValuesWithoutAFunction) {
  Mask mask = Mask::uniform(10, 10, 3);
  fill(mask, 0, 0, 4, 1, 7);
  EXPECT_EQ(unmapped_mistake(mask.pixels_per_tag(), mapped({3, 7})), "");
  expect_says(unmapped_mistake(mask.pixels_per_tag(), mapped({3})), "function: 7 (4 pixels);");
  for (std::size_t i = 0; i < 50; ++i) mask.tags[i] = static_cast<std::uint8_t>(100 + i);
  expect_says(unmapped_mistake(mask.pixels_per_tag(), mapped({3})), "119 (1 pixels) and 30 more;");
}

}  // namespace
}  // namespace nutik::test
