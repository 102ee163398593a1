// What --precision single may err by (docs/explanation/accuracy.md): in light code by code, and in exposures.
#include <gtest/gtest.h>

#include <cmath>

#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

// One sample that holds every code, exposed for as long as it lasts: its weight is 1.
struct EveryCode {
  CaptureFormat format;
  MemoryCapture capture;
  RenderPlan plan;

  explicit EveryCode(const CodeFormat& codes)
      : format(format_of(codes)), capture(capture_of(format)), plan(plan_of(capture)) {}

 private:
  static CaptureFormat format_of(const CodeFormat& codes) {
    return {.shape = {256, (codes.white_code + 256) / 256, 1},
            .code_bytes = codes.code_bytes,
            .white_code = codes.white_code,
            .transfer = codes.transfer};
  }
  static MemoryCapture capture_of(const CaptureFormat& format) {
    Rasters rasters(1, std::vector<std::byte>(format.sample_bytes()));
    for (std::uint32_t i = 0; i < format.shape.value_count(); ++i) {
      set_code(format, rasters[0], i, std::min(i, format.white_code));
    }
    return MemoryCapture(format, Timeline::constant({25, 1}, Timeline::kFullShutter, 1), rasters, 64);
  }
  static RenderPlan plan_of(const MemoryCapture& capture) {
    const Shape& shape = capture.format().shape;
    const std::int64_t duration_ns = capture.timeline().duration_ns();
    return make_plan(capture, {{0, GainFunction::boxcar(0, duration_ns)}},
                     Mask::uniform(shape.width, shape.height, 0), {});
  }
};

// Both ways: by pieces, where 16 lanes are the device's own, and by the curve.
TEST(SinglePrecision, TurnsEveryCodeIntoItsLight) {
  for (const std::uint32_t lanes : {16u, 8u}) {
    OpenClOptions options = renderer_options(Precision::single_);
    options.item_pixels = 64;
    options.lanes = lanes;
    options.looks_up_bytes = false;
    OpenClRenderer renderer(options);
    for (const Transfer& transfer : {Transfer::srgb(), Transfer::bt709()}) {
      for (const auto& [bytes, white] : {std::pair{1u, 255u}, {2u, 1023u}, {2u, 4095u}, {2u, 65'535u}}) {
        EveryCode every({1, bytes, white, transfer});
        const Picture light = renderer.render(every.plan, every.capture, {ValueType::light64, 0}).picture;
        const std::vector<double> exact = transfer.light_of_codes(white);
        double worst = 0.0;
        for (std::uint32_t code = 0; code <= white; ++code) {
          const double error = std::fabs(light.values<double>()[code] - exact[code]);
          ASSERT_LE(error, kCurveLightOfCommonWhites)
              << transfer.text() << ", " << bytes << " byte codes, code " << code << " of " << white;
          worst = std::max(worst, error);
        }
        std::printf("%s, %u lanes, %u byte codes, white %5u: light errs by at most %.3g\n",
                    transfer.text().c_str(), lanes, bytes, white, worst);
      }
    }
  }
}

// Rows of 8 bits have the same floats where processors look light up byte by byte; here without a rounding of the
// weight, and in every place of a tile.
TEST(SinglePrecision, LooksUpByteByByteWhatItWouldCompute) {
  OpenClOptions options = renderer_options(Precision::single_);
  OpenClRenderer bytewise(options);
  if (!bytewise.info().permutes_bytes) GTEST_SKIP() << "this device does not look up bytes";
  options.looks_up_bytes = false;
  OpenClRenderer computing(options);
  for (const Transfer& transfer : {Transfer::srgb(), Transfer::bt709(), Transfer::gamma(2.2)}) {
    EveryCode every({1, 1, 255, transfer});
    const Picture light = bytewise.render(every.plan, every.capture, {ValueType::light64, 0}).picture;
    EXPECT_EQ(light.bytes, computing.render(every.plan, every.capture, {ValueType::light64, 0}).picture.bytes)
        << transfer.text();
  }
}

TEST(SinglePrecision, GivesEveryCodeBack) {
  OpenClRenderer renderer(renderer_options(Precision::single_));
  for (const CodeFormat& codes :
       {CodeFormat{1, 1, 255, Transfer::srgb()}, CodeFormat{1, 2, 65'535, Transfer::srgb()},
        CodeFormat{1, 2, 65'535, Transfer::bt709()}, CodeFormat{1, 2, 65'535, Transfer::linear()},
        CodeFormat{1, 1, 255, Transfer::gamma(2.2)}}) {
    EveryCode every(codes);
    const ValueType type = codes.code_bytes == 1 ? ValueType::code8 : ValueType::code16;
    const Picture picture = renderer.render(every.plan, every.capture, {type, codes.white_code}).picture;
    for (std::uint32_t code = 0; code <= codes.white_code; ++code) {
      ASSERT_EQ(code_at(every.format, picture.bytes, code), code)
          << codes.transfer.text() << ", white " << codes.white_code;
    }
  }
}

// Every transfer function, both depths, one function or many; tiles of every kind in blocks of
// every length.
TEST(SinglePrecision, StaysWithinItsBoundOfTheReference) {
  const CodeFormat formats[] = {{1, 1, 255, Transfer::srgb()},
                                {1, 2, 65'535, Transfer::bt709()},
                                {1, 2, 4095, Transfer::linear()},
                                {1, 1, 255, Transfer::gamma(2.2)},
                                {3, 1, 255, Transfer::bt709()}};
  OpenClRenderer renderer(renderer_options(Precision::single_));
  ReferenceRenderer reference;
  for (const std::uint32_t block_samples : {1u, 2u, 64u, 1000u}) {
    double worst = 0.0, tightest = 0.0;
    for (std::uint64_t seed = 4000; seed < 4050; ++seed) {
      const RandomCase random(seed, formats[seed % std::size(formats)]);
      Picture expected;
      for (const TilePolicy policy :
           {TilePolicy::dense, TilePolicy::rows, TilePolicy::records, TilePolicy::automatic}) {
        MemoryCapture capture = random.encode(block_samples, policy);
        const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
        if (policy == TilePolicy::dense) {
          expected = reference.render(plan, capture, {ValueType::light64, 0}).picture;
        }
        const Picture light = renderer.render(plan, capture, {ValueType::light64, 0}).picture;
        const Difference difference = difference_of(plan, light, expected);
        const Difference share = share_of_bound(plan, Precision::single_, light, expected);
        ASSERT_LE(share.worst, 1.0) << random.text() << ", here in blocks of " << block_samples << ", tiles "
                                    << to_text(policy) << ", value " << difference.value << ": "
                                    << light.values<double>()[difference.value] << " and "
                                    << expected.values<double>()[difference.value]
                                    << "; rerun: opencl_tests --gtest_filter=SinglePrecision*Reference";
        worst = std::max(worst, difference.worst);
        tightest = std::max(tightest, share.worst);
      }
    }
    std::printf("blocks of %4u: worst difference %.3g of ∫|g|/D, %.3g of its bound\n", block_samples, worst,
                tightest);
  }
}

}  // namespace
}  // namespace nutik::test
