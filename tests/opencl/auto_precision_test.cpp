// `auto`: no more arithmetic than the picture needs, and no less.
#include <gtest/gtest.h>

#include <cmath>

#include "render/reference_renderer.hpp"
#include "render/renderer.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

// 240 samples at 240 a second, sRGB of 8 bits: random codes, moving or still.
MemoryCapture clip(bool is_still = false) {
  const CaptureFormat format{.shape = {24, 16, 3}};
  Random random(11);
  Rasters rasters = random_rasters(random, format, 240);
  if (is_still) std::fill(rasters.begin(), rasters.end(), rasters.front());
  return {format, Timeline::constant({240, 1}, Timeline::kFullShutter, 240), rasters, 64};
}

// Half a second of `gain`, then half a second that leaves a still gain of 1.
FunctionSet nearly_nothing_of(double gain) {
  return {{0, GainFunction({{500'000'000, gain}, {500'000'000, 2 - gain}})}};
}

int worst_code_difference(const Picture& a, const Picture& b) {
  int worst = 0;
  for (std::uint64_t i = 0; i < a.shape.value_count(); ++i) {
    worst = std::max(worst, std::abs(a.values<std::uint8_t>()[i] - b.values<std::uint8_t>()[i]));
  }
  return worst;
}

TEST(AutoPrecision, TakesSingleForOrdinaryExposuresOf8Bits) {
  MemoryCapture capture = clip();
  OpenClRenderer renderer(renderer_options(std::nullopt));
  for (const GainFunction& function :
       {GainFunction::boxcar(0, 1'000'000'000), GainFunction::boxcar(100'000'000, 104'000'000),
        GainFunction({{0, 0.0}, {200'000'000, 1.0}, {300'000'000, -0.5}, {400'000'000, 0.0}})}) {
    const RenderPlan plan = make_plan(capture, {{0, function}}, Mask::uniform(24, 16, 0), {});
    const Rendered rendered = renderer.render(plan, capture, {ValueType::code8, 255});
    EXPECT_EQ(rendered.precision, Precision::single_)
        << error_text(rendered.choice->bound.worst, {ValueType::code8, 255});
    EXPECT_TRUE(rendered.warnings.empty());
    const Picture expected = ReferenceRenderer().render(plan, capture, {ValueType::code8, 255}).picture;
    EXPECT_LE(worst_code_difference(rendered.picture, expected), 1);
  }
}

// ∫g is a billionth of ∫|g|: hardly anything is left of a still scene, and that is the picture.
TEST(AutoPrecision, TakesMoreWhereSingleIsWrong) {
  MemoryCapture capture = clip(true);
  const double gain = has(Precision::double_) ? 1e9 : 1e7;  // pairs of floats have fewer digits
  const RenderPlan plan = make_plan(capture, nearly_nothing_of(gain), Mask::uniform(24, 16, 0), {});
  EXPECT_NEAR(plan.functions[0].summary.still_gain(), 1.0, 1e-6);
  const OutputFormat codes{ValueType::code8, 255};
  const Picture expected = ReferenceRenderer().render(plan, capture, codes).picture;
  OpenClRenderer chosen(renderer_options(std::nullopt));
  OpenClRenderer single(renderer_options(Precision::single_));
  EXPECT_GT(worst_code_difference(single.render(plan, capture, codes).picture, expected), 1);
  const Rendered rendered = chosen.render(plan, capture, codes);
  EXPECT_LE(worst_code_difference(rendered.picture, expected), 1);
  EXPECT_NE(rendered.precision, Precision::single_);
  EXPECT_TRUE(rendered.choice->is_right_enough());
  ASSERT_FALSE(rendered.choice->rejected.empty());
  EXPECT_EQ(rendered.choice->rejected.front().precision, Precision::single_);
  const std::string report = rendering_report(rendered, codes);
  expect_says(report, "not single: only light within");
}

// What costs more than the format can show is left out; what a finer format shows is not.
TEST(AutoPrecision, DependsOnTheFormat) {
  MemoryCapture capture = clip();
  const RenderPlan plan =
      make_plan(capture, {{0, GainFunction::boxcar(0, 1'000'000'000)}}, Mask::uniform(24, 16, 0), {});
  const auto chosen = [&](const OutputFormat& output) {
    return choose_precision(plan, output, first_precisions()).precision();
  };
  EXPECT_EQ(chosen({ValueType::code8, 255}), Precision::single_);
  EXPECT_EQ(chosen({ValueType::code16, 65'535}), Precision::single_);
  EXPECT_NE(chosen({ValueType::light32, 0}), Precision::single_);
}

// In the dark sums of light that is nowhere taken away err by little; else by what was added and taken away.
TEST(AutoPrecision, TakesSingleFor16BitsWithoutNegativeGain) {
  MemoryCapture capture = clip();
  const auto chosen = [&](const std::vector<ControlPoint>& points) {
    const RenderPlan plan = make_plan(capture, {{0, GainFunction(points)}}, Mask::uniform(24, 16, 0), {});
    return choose_precision(plan, {ValueType::code16, 65'535}, first_precisions()).precision();
  };
  EXPECT_EQ(chosen({{0, 0.0}, {200'000'000, 1.0}, {300'000'000, 0.5}, {700'000'000, 0.1}}), Precision::single_);
  EXPECT_NE(chosen({{0, 0.0}, {200'000'000, 1.0}, {300'000'000, -0.5}, {700'000'000, 0.1}}), Precision::single_);
}

TEST(AutoPrecision, SaysWhereNoArithmeticIsRightEnough) {
  MemoryCapture capture = clip();
  const RenderPlan plan = make_plan(capture, nearly_nothing_of(1e15), Mask::uniform(24, 16, 0), {});
  OpenClRenderer renderer(renderer_options(std::nullopt));
  const Rendered rendered = renderer.render(plan, capture, {ValueType::code8, 255});
  EXPECT_FALSE(rendered.choice->is_right_enough());
  for (const ErrorBound& bound : rendered.choice->rejected) {
    EXPECT_LE(rendered.choice->bound.worst.steps, bound.worst.steps) << to_text(bound.precision);
  }
  ASSERT_EQ(rendered.warnings.size(), 1u);
  expect_says(rendered.warnings.front(), "is the closest");
}

}  // namespace
}  // namespace nutik::test
