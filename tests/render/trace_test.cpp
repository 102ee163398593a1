// A trace is the reference's walk: it comes to the same bits, and its steps to the sum.
#include "render/trace.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "capture/error.hpp"
#include "render/reference_renderer.hpp"
#include "support/bounds.hpp"
#include "support/packed_capture.hpp"
#include "support/random_case.hpp"
#include "support/soft_mask.hpp"

namespace nutik::test {
namespace {

TEST(Trace, EqualsTheReferenceToTheLastBit) {
  std::uint64_t compared = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomCase random(seed);
    SCOPED_TRACE(random.text());
    if (seed % 2 == 1) soften(random.mask, random.functions, seed);
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const Picture picture = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
    PackedCapture packed(capture, 2);
    Random draw(seed);
    for (int i = 0; i < 10; ++i) {
      const auto x = static_cast<std::uint32_t>(draw.whole(0, picture.shape.width - 1));
      const auto y = static_cast<std::uint32_t>(draw.whole(0, picture.shape.height - 1));
      const std::vector<Trace> traces = trace_pixel(plan, capture, x, y);
      const std::array<double, 3> light = light_of(traces);
      EXPECT_EQ(light_of(trace_pixel(plan, packed, x, y)), light);
      const std::uint32_t channels = traces.front().channels;
      ASSERT_EQ(channels, picture.shape.channels);
      for (std::uint32_t channel = 0; channel < channels; ++channel) {
        const double reference =
            picture.values<double>()[(std::uint64_t{y} * picture.shape.width + x) * channels + channel];
        EXPECT_EQ(std::bit_cast<std::uint64_t>(light[channel]), std::bit_cast<std::uint64_t>(reference))
            << "pixel " << x << "," << y << ": " << light[channel] << " and " << reference;
        ++compared;
      }
    }
  }
  RecordProperty("compared", std::to_string(compared));
}

TEST(Trace, StepsFollowEachOtherAndAddUp) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {.live_all = true});
    const Trace trace = trace_pixel(plan, capture, 0, 0).front();
    ASSERT_FALSE(trace.steps.empty());
    EXPECT_EQ(trace.steps.front().begin_ns, 0);
    EXPECT_EQ(trace.steps.back().end_ns, plan.duration_ns);
    const PlannedFunction& planned = plan.functions[trace.function];
    double sum = 0.0, absolute = 0.0;
    for (std::size_t i = 0; i < trace.steps.size(); ++i) {
      const TraceStep& step = trace.steps[i];
      ASSERT_LT(step.begin_ns, step.end_ns);
      if (i > 0) {
        ASSERT_EQ(step.begin_ns, trace.steps[i - 1].end_ns);
      }
      // Gain and light by Simpson's rule, which is exact for their product.
      const auto length = static_cast<double>(step.end_ns - step.begin_ns);
      const TraceStep::Value& value = step.values[0];
      const double middle = (step.begin_gain + step.end_gain) / 2 * (value.begin_light + value.end_light) / 2;
      const double simpson =
          length / 6 * (step.begin_gain * value.begin_light + 4 * middle + step.end_gain * value.end_light);
      const double scale =
          length * std::max(std::fabs(step.begin_gain), std::fabs(step.end_gain));  // light is at most 1
      EXPECT_NEAR(value.integral_ns, simpson, 20 * kRoundoff64 * scale);
      sum += value.integral_ns;
      absolute += std::fabs(value.integral_ns);
      EXPECT_NEAR(value.sum_ns, sum, static_cast<double>(i + 2) * kRoundoff64 * absolute);
    }
    if (planned.summary.support_ns == 0) continue;
    EXPECT_EQ(trace.light[0],
              trace.steps.back().values[0].sum_ns / static_cast<double>(planned.summary.support_ns));
  }
}

// Only the packed tiles with a pixel of the region are unpacked.
TEST(Trace, ARegionIsTheMeanOfItsPixels) {
  double worst = 0.0;
  std::uint64_t left_out = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    MemoryCapture capture = random.encode();
    PackedCapture packed(capture, 1);
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const Picture picture = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
    for (std::size_t f = 0; f < plan.functions.size(); ++f) {
      const PlannedFunction& planned = plan.functions[f];
      const Trace trace = trace_region(plan, packed, planned.tag);
      EXPECT_EQ(trace.pixel_count, planned.pixel_count);
      for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
        double sum = 0.0;
        for (std::uint64_t pixel = 0; pixel < picture.shape.pixel_count(); ++pixel) {
          if (plan.function_of(pixel) == f) {
            sum += picture.values<double>()[pixel * trace.channels + channel];
          }
        }
        const double scale = planned.summary.error_scale();
        const double mean = sum / static_cast<double>(planned.pixel_count);
        // Both walks err as the reference may; the plain sum above by a rounding a pixel; the mean light
        // by a few of its own.
        const double bound =
            (2 * kReferenceRoundings + static_cast<double>(planned.pixel_count) + 4) * kRoundoff64 * scale;
        EXPECT_NEAR(trace.light[channel], mean, bound) << "M" << int{planned.tag};
        if (scale > 0) worst = std::max(worst, std::fabs(trace.light[channel] - mean) / scale);
      }
    }
    left_out += packed.groups_left_out;
  }
  EXPECT_GT(left_out, 0u);
  std::printf("worst difference: %.3g of S\n", worst);
}

// Two pixels, one of light 1 and one of 0.2, of which the function has a quarter and all.
TEST(Trace, OfARegionCountsPixelsByTheirShares) {
  const CaptureFormat format{{2, 1, 1}, 1, 5, Transfer::linear(), {}};
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, 1),
                        Rasters{{std::byte{5}, std::byte{1}}}, 1);
  Mask mask = Mask::uniform(2, 1, 9);
  mask.tags[0] = 4;
  mask.mixed.add(0, std::array<Share, 2>{{{4, 3 * 13'107 + 6'554 + 3'277}, {9, 16'383}}});
  const FunctionSet functions{{4, GainFunction({{0, 1.0}})}, {9, GainFunction({{0, 1.0}})}};
  const RenderPlan plan = make_plan(capture, functions, mask, {});
  const Trace trace = trace_region(plan, capture, 9);
  EXPECT_EQ(trace.pixel_count, 2u);
  const double quarter = 16'383.0 / 65'535;
  EXPECT_NEAR(trace.light[0], (quarter * 1.0 + 0.2) / (quarter + 1), 1e-15);
}

// As a damaged file may have them.
TEST(Trace, OfARegionTakesCodesAboveWhiteForWhite) {
  const CaptureFormat format{{8, 4, 1}, 2, 65'535, Transfer::linear(), {}};
  std::vector<std::byte> raster(format.sample_bytes(), std::byte{0xFF});
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, 2),
                        std::vector{raster, raster}, 2);
  const FunctionSet functions{{0, GainFunction({{0, 1.0}})}};
  RenderPlan plan = make_plan(capture, functions, Mask::uniform(8, 4, 0), {});
  plan.capture.white_code = 1023;
  EXPECT_EQ(trace_region(plan, capture, 0).light[0], 1.0);
}

TEST(Trace, NamesWhatThereIsNot) {
  const RandomCase random(3);
  MemoryCapture capture = random.encode();
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
  EXPECT_THROW(static_cast<void>(trace_pixel(plan, capture, random.capture.shape.width, 0)), UsageError);
  EXPECT_THROW(static_cast<void>(trace_pixel(plan, capture, 0, random.capture.shape.height)), UsageError);
  std::uint8_t unused = 255;
  while (random.mask.pixels_per_tag()[unused] != 0) --unused;
  EXPECT_THROW(static_cast<void>(trace_region(plan, capture, unused)), UsageError);
}

}  // namespace
}  // namespace nutik::test
