#include "session/requests/output_request.hpp"

#include <gtest/gtest.h>

#include "support/messages.hpp"

namespace nutik::test {
namespace {

CaptureFormat twelve_bits() {
  return {.shape = {2, 1, 3}, .code_bytes = 2, .white_code = 4095, .transfer = Transfer::linear()};
}

OutputRequest of_transfer(const char* text) { return {{}, {}, parse_out_transfer(text)}; }

TEST(OutputRequest, IsShownOverTheFullRangeUnlessAskedForOtherwise) {
  const OutputFormat own = output_format({}, "picture.png", twelve_bits());
  EXPECT_EQ(own.type, ValueType::code16);
  EXPECT_EQ(own.white_code, 65'535u);
  EXPECT_EQ(own.transfer, Transfer::srgb());
  const OutputFormat eight = output_format({Depth::bits8, {}}, "picture.png", twelve_bits());
  EXPECT_EQ(eight.type, ValueType::code8);
  EXPECT_EQ(eight.white_code, 255u);
  EXPECT_EQ(eight.transfer, Transfer::srgb());
  EXPECT_EQ(output_format(of_transfer("gamma:1.8"), "picture.png", twelve_bits()).transfer,
            Transfer::gamma(1.8));
  EXPECT_EQ(output_format({}, "picture.pfm", twelve_bits()).type, ValueType::light32);
  EXPECT_EQ(output_format({Depth::floating, {}}, twelve_bits()).type, ValueType::light32) << "of no file";
}

TEST(OutputRequest, KeepsTheSourcesCodesAndWhite) {
  const OutputFormat own = output_format(of_transfer("source"), "picture.png", twelve_bits());
  EXPECT_EQ(own.white_code, 4095u);
  EXPECT_EQ(own.transfer, std::nullopt);
  OutputRequest eight = of_transfer("source");
  eight.depth = Depth::bits8;
  EXPECT_EQ(output_format(eight, "picture.png", twelve_bits()).white_code, 255u) << "another depth";
  EXPECT_EQ(output_format(eight, "picture.png", twelve_bits()).transfer, std::nullopt);
}

TEST(OutputRequest, RefusesCodesOfFloatingPoint) {
  EXPECT_EQ(output_format(of_transfer("linear"), "picture.pfm", twelve_bits()).type, ValueType::light32);
  for (const char* text : {"srgb", "source"}) {
    expect_error<UsageError>([&] { return output_format(of_transfer(text), "picture.pfm", twelve_bits()); },
                             {"which is linear"});
  }
  for (const char* text : {"pq", "hlg", "sRGB", ""}) {
    expect_error<UsageError>([&] { return parse_out_transfer(text); }, {"choose srgb"});
  }
}

TEST(OutputRequest, SaysHowCodesDifferFromTheCaptures) {
  CaptureFormat capture = twelve_bits();
  EXPECT_EQ(codes_text(capture, output_format({}, "a.png", capture)),
            ", codes srgb with white 65535 (the capture's: linear with white 4095)");
  EXPECT_EQ(codes_text(capture, output_format({Depth::bits8, {}}, "a.png", capture)),
            ", codes srgb (the capture's: linear)");
  EXPECT_EQ(codes_text(capture, output_format(of_transfer("source"), "a.png", capture)), "");
  EXPECT_EQ(codes_text(capture, output_format({}, "a.pfm", capture)), "");
  capture.transfer = Transfer::srgb();
  EXPECT_EQ(codes_text(capture, output_format({Depth::bits8, {}}, "a.png", capture)), "");
  capture.white_code = 65'535;
  EXPECT_EQ(codes_text(capture, output_format({}, "a.png", capture)), "");
  capture.shape.channels = 3;
  capture.primaries = Primaries::p3;
  EXPECT_EQ(codes_text(capture, output_format({}, "a.png", capture)),
            ", codes srgb in bt709 (the capture's: srgb in p3)");
}

TEST(OutputRequest, AsksWhatBecomesOfLightBelowZeroOfCodesOnly) {
  const OutputRequest offset{{}, NegativeLight::offset};
  EXPECT_EQ(output_format(offset, "picture.png", twelve_bits()).negative, NegativeLight::offset);
  EXPECT_THROW(static_cast<void>(output_format(offset, "picture.pfm", twelve_bits())), UsageError);
}

}  // namespace
}  // namespace nutik::test
