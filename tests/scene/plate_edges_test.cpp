// A thing before the plate, the hole that it left, and a thing of which the plate shows a part.
#include "scene/clean_plate.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <optional>

#include "mask/distance.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kSide = 60, kThing = 24, kTop = 18, kMargin = 2, kByCodes = 15;

// A bright thing so far from the left, or the empty ground. It ripples by a few codes.
template <typename Code>
Picture picture_of(ValueType type, std::uint32_t unit, std::optional<std::uint32_t> left) {
  Picture picture({kSide, kSide, 1}, type, 255 * unit);
  const auto values = picture.values<Code>();
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const bool is_thing = left && x >= *left && x < *left + kThing && y >= kTop && y < kTop + kThing;
      values[y * kSide + x] = static_cast<Code>(unit * (is_thing ? 220 : 100 + (x * 7 + y * 3) % 5));
    }
  }
  return picture;
}

template <typename Code>
double share(ValueType type, std::uint32_t unit, std::optional<std::uint32_t> in_picture,
             std::optional<std::uint32_t> in_plate, std::size_t from_column = 0) {
  const Picture picture = picture_of<Code>(type, unit, in_picture),
                plate = picture_of<Code>(type, unit, in_plate);
  Region region = Region::none(kSide, kSide);
  const auto a = picture.values<Code>(), b = plate.values<Code>();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool counts = i % kSide >= from_column;
    region.inside[i] = counts && std::abs(int{a[i]} - int{b[i]}) > static_cast<int>(kByCodes * unit) ? 1 : 0;
  }
  return plate_edge_share(picture, plate, grown(region, kMargin), kByCodes * unit, kMargin);
}

TEST(PlateEdges, AreNoneOfAThingAndAllOfAHole) {
  EXPECT_EQ(share<std::uint8_t>(ValueType::code8, 1, 18, std::nullopt), 0);
  // At corners neither has one.
  EXPECT_GE(share<std::uint8_t>(ValueType::code8, 1, std::nullopt, 18), 0.8);
  EXPECT_EQ(share<std::uint16_t>(ValueType::code16, 16, 18, std::nullopt), 0);
  EXPECT_GE(share<std::uint16_t>(ValueType::code16, 16, std::nullopt, 18), 0.8);
}

// 16 of its 24 columns differ: at the left of these the plate's thing ends, at all other sides the picture's.
TEST(PlateEdges, AreSomeOfAThingThatThePlateShowsAPartOf) {
  EXPECT_NEAR(share<std::uint8_t>(ValueType::code8, 1, 26, 10, 34), 24.0 / (2 * (16 + 24)), 0.08);
}

TEST(PlateEdges, AreNoneOfARegionTooSmallToTell) {
  const Picture picture = picture_of<std::uint8_t>(ValueType::code8, 1, 18);
  Region region = Region::none(kSide, kSide);
  EXPECT_EQ(plate_edge_share(picture, picture, region, kByCodes, kMargin), 0);
  region.inside[30 * kSide + 30] = 1;
  EXPECT_EQ(plate_edge_share(picture, picture, region, kByCodes, kMargin), 0);
}

}  // namespace
}  // namespace nutik
