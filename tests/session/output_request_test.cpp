#include "session/output_request.hpp"

#include <gtest/gtest.h>

namespace nutik {
namespace {

CaptureFormat twelve_bits() {
  CaptureFormat format;
  format.shape = {2, 1, 3};
  format.code_bytes = 2;
  format.white_code = 4095;
  return format;
}

TEST(OutputRequest, KeepsTheCapturesCodesUnlessAskedForOthers) {
  const OutputFormat own = output_format({}, "picture.png", twelve_bits());
  EXPECT_EQ(own.type, ValueType::code16);
  EXPECT_EQ(own.white_code, 4095u);
  const OutputFormat eight = output_format({Depth::bits8, {}}, "picture.png", twelve_bits());
  EXPECT_EQ(eight.type, ValueType::code8);
  EXPECT_EQ(eight.white_code, 255u);
  EXPECT_EQ(output_format({}, "picture.pfm", twelve_bits()).type, ValueType::light32);
  EXPECT_EQ(output_format({Depth::floating, {}}, twelve_bits()).type, ValueType::light32) << "of no file";
}

TEST(OutputRequest, AsksWhatBecomesOfLightBelowZeroOfCodesOnly) {
  const OutputRequest offset{{}, NegativeLight::offset};
  EXPECT_EQ(output_format(offset, "picture.png", twelve_bits()).negative, NegativeLight::offset);
  EXPECT_THROW(static_cast<void>(output_format(offset, "picture.pfm", twelve_bits())), LightIsKept);
}

}  // namespace
}  // namespace nutik
