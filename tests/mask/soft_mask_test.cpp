// Soft masks: feathered edges and layers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "capture/error.hpp"
#include "mask/feather.hpp"
#include "mask/layers.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

using Shares = std::vector<Share>;

Shares shares_at(const Mask& mask, std::uint64_t pixel) {
  const auto shares = mask.mixed.of(pixel);
  return shares.empty() ? Shares{{mask.tags[pixel], 65'535}} : Shares(shares.begin(), shares.end());
}

Mask row_of(std::vector<std::uint8_t> tags) {
  return {static_cast<std::uint32_t>(tags.size()), 1, std::move(tags), {}};
}

TEST(Feather, IsReadFromText) {
  EXPECT_EQ(Feather::parse("6px").of(3), 600);
  EXPECT_EQ(Feather::parse("2.5px").of(0), 250);
  EXPECT_EQ(Feather::parse("0px").of(0), 0);
  const Feather several = Feather::parse("2px,M255=6.25px,m3=0px");
  EXPECT_EQ(several.of(0), 200);
  EXPECT_EQ(several.of(255), 625);
  EXPECT_EQ(several.of(3), 0);
  EXPECT_EQ(Feather::parse("255=6px").of(254), 0);
  EXPECT_NE(several, Feather::parse("2px"));
}

TEST(Feather, RefusesWhatIsNone) {
  const auto message = [](const std::string& text) {
    return message_of<UsageError>([&] { return Feather::parse(text); });
  };
  for (const char* text : {"", "6", "px", "6 px", "-1px", ".5px", "1.px", "1.2.3px", "1.255px", "6px,",
                           "99999999999999999999px"}) {
    EXPECT_NE(message(text).find("the feather"), std::string::npos) << text;
  }
  EXPECT_EQ(message("501px"), "the feather '501px' reaches too far; at most 500 pixels");
  EXPECT_EQ(message("1px,2px"), "the feather '1px,2px' says twice how far all edges reach");
  for (const std::string tag : {"M256", "M", "", "M0009", "9x", "m-1"}) {
    EXPECT_EQ(message(tag + "=1px"), "the feather '" + tag + "=1px' names no mask value: M0=6px … M255=6px");
  }
  EXPECT_EQ(message("M9=1px,9=2px"), "the feather 'M9=1px,9=2px' names M9 twice");
  EXPECT_EQ(message_of<UsageError>([] {
              return feathered(row_of({0, 9}), Feather::parse("M4=1px"));
            }),
            "no pixel of the mask has the value 4, which has a feather");
}

// Weights 3, 2, 1 of the pixels no further than 2: of those that there are.
TEST(Feather, ByHand) {
  const Mask soft = feathered(row_of({0, 0, 0, 9, 9, 9}), Feather::parse("2px"));
  EXPECT_EQ(shares_at(soft, 0), (Shares{{0, 65'535}}));
  EXPECT_EQ(shares_at(soft, 1), (Shares{{0, 57'343}, {9, 8'192}}));  // 7 to 1
  EXPECT_EQ(shares_at(soft, 2), (Shares{{0, 43'690}, {9, 21'845}}));
  EXPECT_EQ(shares_at(soft, 3), (Shares{{0, 21'845}, {9, 43'690}}));
  EXPECT_EQ(shares_at(soft, 5), (Shares{{9, 65'535}}));
  EXPECT_EQ(soft.tags, (std::vector<std::uint8_t>{0, 0, 0, 9, 9, 9}));
  const Mask hard = row_of({0, 0, 9});
  EXPECT_EQ(feathered(hard, Feather::parse("0px")), hard);
}

// Within a row, too, which may take long.
TEST(Feather, AsksWhetherToGoOn) {
  std::vector<std::uint8_t> tags(1000);
  for (std::size_t x = 0; x < tags.size(); ++x) tags[x] = static_cast<std::uint8_t>(x);
  int asked = 0;
  const auto stops = [&](std::uint64_t, std::uint64_t) {
    if (++asked > 10) throw Cancelled();
  };
  EXPECT_THROW(static_cast<void>(feathered(row_of(tags), Feather::parse("300px"), stops)), Cancelled);
}

// Against the formula, pixel by pixel.
TEST(Feather, IsTheMaskUnderItsKernel) {
  Random random(8);
  Mask mask = Mask::uniform(41, 23, 0);
  for (int patch = 0; patch < 12; ++patch) {
    const auto left = random.whole(0, 40), top = random.whole(0, 22), size = random.whole(1, 12);
    const auto tag = static_cast<std::uint8_t>(random.whole(0, 4) * 60);
    for (std::int64_t y = top; y < std::min<std::int64_t>(23, top + size); ++y) {
      for (std::int64_t x = left; x < std::min<std::int64_t>(41, left + size); ++x) {
        mask.tags[static_cast<std::size_t>(y * 41 + x)] = tag;
      }
    }
  }
  for (const double reach : {1.0, 2.5, 6.0}) {
    const Mask soft = feathered(mask, {static_cast<std::int32_t>(std::lround(reach * 100)), {}});
    const auto weight = [&](std::int64_t distance) {
      return std::max(0.0, reach + 1 - std::fabs(static_cast<double>(distance)));
    };
    for (std::int64_t y = 0; y < 23; ++y) {
      for (std::int64_t x = 0; x < 41; ++x) {
        std::array<double, 256> wanted{};
        double all = 0.0;
        for (std::int64_t v = 0; v < 23; ++v) {
          for (std::int64_t u = 0; u < 41; ++u) {
            wanted[mask.tags[static_cast<std::size_t>(v * 41 + u)]] += weight(u - x) * weight(v - y);
            all += weight(u - x) * weight(v - y);
          }
        }
        std::array<double, 256> found{};
        for (const Share& share : shares_at(soft, static_cast<std::uint64_t>(y * 41 + x)))
          found[share.of] = share.size;
        for (std::size_t tag = 0; tag < 256; ++tag) {
          ASSERT_NEAR(found[tag], wanted[tag] / all * 65'535, 1.0)
              << x << "," << y << " M" << tag << ", " << reach;
        }
      }
    }
  }
}

// An edge is as wide as the wider of its two tags; others stay as they are.
TEST(Feather, OfOneTagBlendsItsEdgesAlone) {
  const Mask hard = row_of({4, 4, 4, 0, 0, 0, 0, 0, 9, 9, 9, 9});
  const Mask all = feathered(hard, Feather::parse("2px"));
  const Mask one = feathered(hard, Feather::parse("M9=2px"));
  for (std::uint64_t x = 0; x < 6; ++x) EXPECT_EQ(shares_at(one, x), (Shares{{hard.tags[x], 65'535}})) << x;
  for (std::uint64_t x = 6; x < 12; ++x) EXPECT_EQ(shares_at(one, x), shares_at(all, x)) << x;
  // Beside the wide edge the narrow one is what it is by itself.
  const Mask both = feathered(hard, Feather::parse("1px,M9=2px"));
  const Mask narrow = feathered(hard, Feather::parse("1px"));
  for (std::uint64_t x = 0; x < 6; ++x) EXPECT_EQ(shares_at(both, x), shares_at(narrow, x)) << x;
  for (std::uint64_t x = 6; x < 12; ++x) EXPECT_EQ(shares_at(both, x), shares_at(all, x)) << x;
  // A tag between two others, one of them wide: what the wide one leaves is shared as if it were not there.
  const Mask near = feathered(row_of({4, 4, 0, 9, 9, 9}), Feather::parse("M9=2px"));
  EXPECT_EQ(shares_at(near, 1).size(), 2u);
  EXPECT_EQ(shares_at(near, 1)[0].of, 4) << "no share of M0, which is beside it";
}

MaskLayer layer(std::uint8_t tag, std::vector<std::uint8_t> codes) {
  MaskLayer layer{tag, "layer-" + std::to_string(tag) + ".png",
                  Picture({static_cast<std::uint32_t>(codes.size()), 1, 1}, ValueType::code8, 255)};
  std::ranges::copy(codes, layer.picture.values<std::uint8_t>().begin());
  return layer;
}

TEST(Layers, LeaveTheRestToOneTag) {
  const Mask mask = mask_of_layers(std::array{layer(9, {0, 64, 255}), layer(200, {0, 100, 0})}, 3);
  EXPECT_EQ(shares_at(mask, 0), (Shares{{3, 65'535}}));
  EXPECT_EQ(shares_at(mask, 1), (Shares{{3, 91 * 257}, {9, 64 * 257}, {200, 100 * 257}}));
  EXPECT_EQ(shares_at(mask, 2), (Shares{{9, 65'535}}));
  EXPECT_EQ(mask.tags[1], 200);
  // The tag may have a layer of its own.
  EXPECT_EQ(shares_at(mask_of_layers(std::array{layer(0, {55}), layer(1, {100})}, 0), 0),
            (Shares{{0, 155 * 257}, {1, 100 * 257}}));
}

TEST(Layers, ComeToNoMoreThanAllOfAPixel) {
  // 128 + 128 is one code more than white: what rounding two halves makes.
  EXPECT_EQ(shares_at(mask_of_layers(std::array{layer(0, {128}), layer(1, {128})}, 0), 0),
            (Shares{{0, 32'768}, {1, 32'767}}));
  EXPECT_EQ(message_of<InputError>([] {
              return mask_of_layers(std::array{layer(0, {255, 128, 255}), layer(7, {0, 129, 51})}, 0);
            }),
            "the layers of the mask come to more than all of 2 pixels: to 1.008 at 1,0 (layer-0.png 0.502, "
            "layer-7.png "
            "0.5059); darken them where they overlap, so that they come to 1 at most");
  EXPECT_EQ(message_of<InputError>([] {
              return mask_of_layers(std::array{layer(0, {255, 128}), layer(7, {0})}, 0);
            }),
            "layer-7.png has 1 x 1 pixels and layer-0.png has 2 x 1; layers of a mask have one size");
}

TEST(Layers, OfAMaskMakeItAgain) {
  Mask hard = Mask::uniform(30, 20, 7);
  for (std::size_t pixel = 200; pixel < 430; ++pixel) hard.tags[pixel] = pixel % 3 == 0 ? 90 : 255;
  const Mask soft = feathered(hard, Feather::parse("3px"));
  ASSERT_TRUE(soft.is_soft());
  std::vector<MaskLayer> layers;
  for (const std::uint8_t tag : std::vector<std::uint8_t>{7, 90, 255})
    layers.push_back({tag, "", layer_of(soft, tag)});
  EXPECT_EQ(mask_of_layers(layers, 7), soft);
}

}  // namespace
}  // namespace nutik::test
