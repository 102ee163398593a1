// Codes of light of either sign, and what counts as saturated.
#include "render/code_scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace nutik {
namespace {

const Transfer kTransfers[] = {Transfer::srgb(), Transfer::bt709(), Transfer::linear(), Transfer::gamma(2.2)};

CodeScale scale_of(const Transfer& transfer, std::uint32_t white_code, NegativeLight negative) {
  return {transfer, {white_code > 255 ? ValueType::code16 : ValueType::code8, white_code, negative}};
}

TEST(CodeScale, GivesCodesBackAndNeverSaturatesThem) {
  for (const Transfer& transfer : kTransfers) {
    for (const std::uint32_t white : {255u, 4095u, 65'535u}) {
      for (const NegativeLight negative : {NegativeLight::saturate, NegativeLight::absolute}) {
        const CodeScale scale = scale_of(transfer, white, negative);
        for (std::uint32_t code = 0; code <= white; ++code) {
          const double light = transfer.light_of(static_cast<double>(code) / white);
          ASSERT_EQ(scale.code_of(light), code) << transfer.text();
          ASSERT_FALSE(scale.saturates_below(light) || scale.saturates_above(light))
              << transfer.text() << code;
        }
      }
    }
  }
}

TEST(CodeScale, OffsetMirrorsAboutTheMiddle) {
  for (const Transfer& transfer : kTransfers) {
    const CodeScale scale = scale_of(transfer, 255, NegativeLight::offset);
    EXPECT_EQ(scale.code_of(0.0), 128u);
    EXPECT_EQ(scale.code_of(1.0), 255u);
    EXPECT_EQ(scale.code_of(-1.0), 1u);
    std::uint32_t last = 0;
    for (int i = -1200; i <= 1200; ++i) {
      const double light = i / 1000.0;
      const std::uint32_t code = scale.code_of(light);
      EXPECT_GE(code, last);
      last = code;
      EXPECT_EQ(code + scale.code_of(-light), 256u) << transfer.text() << light;
    }
    // What cancels but for roundings.
    EXPECT_EQ(scale.code_of(1e-12), 128u);
    EXPECT_EQ(scale.code_of(-1e-12), 128u);
    EXPECT_EQ(scale_of(transfer, 254, NegativeLight::offset).code_of(-1.0), 0u);
  }
}

// Where a code more on either side would be taken, if there were one.
TEST(CodeScale, SaturatesWhereTheNextCodeWouldBegin) {
  for (const Transfer& transfer : kTransfers) {
    const double white_edge = transfer.light_of(255.5 / 255);
    const double black_edge = transfer.light_of(0.5 / 255);
    const CodeScale saturate = scale_of(transfer, 255, NegativeLight::saturate);
    EXPECT_TRUE(saturate.saturates_above(white_edge * (1 + 1e-12)));
    EXPECT_FALSE(saturate.saturates_above(white_edge * (1 - 1e-12)));
    EXPECT_TRUE(saturate.saturates_below(-black_edge * (1 + 1e-12)));
    EXPECT_FALSE(saturate.saturates_below(-black_edge * (1 - 1e-12)));
    const CodeScale absolute = scale_of(transfer, 255, NegativeLight::absolute);
    EXPECT_TRUE(absolute.saturates_above(-white_edge * (1 + 1e-12)));
    EXPECT_FALSE(absolute.saturates_below(-1e9));
    const CodeScale offset = scale_of(transfer, 255, NegativeLight::offset);
    EXPECT_FALSE(offset.saturates_below(-1.0) || offset.saturates_above(1.0));
    EXPECT_TRUE(offset.saturates_below(-transfer.light_of(1 + 0.51 / 127)));
    EXPECT_TRUE(offset.saturates_above(transfer.light_of(1 + 0.51 / 127)));
  }
}

TEST(CodeScale, CountsAPixelOnceAtEachEnd) {
  Picture light({3, 1, 3}, ValueType::light64, 255);
  const auto values = light.values<double>();
  const double pixels[9] = {-1, -2, 3, 0, 0.5, 1, 2, 2, 2};
  std::copy(std::begin(pixels), std::end(pixels), values.begin());
  const Saturation saturation =
      count_saturated(light, scale_of(Transfer::srgb(), 255, NegativeLight::saturate));
  EXPECT_EQ(saturation, (Saturation{1, 2}));
}

}  // namespace
}  // namespace nutik
