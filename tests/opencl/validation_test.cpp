// validate(): its figures against the tests' own comparison, and what it says of a wrong picture.
#include "opencl/validation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

TEST(Validation, FiguresAreThoseOfASecondComputation) {
  const RandomCase random(3, {3, 1, 255, Transfer::srgb()});
  MemoryCapture capture = random.encode();
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
  const OutputFormat output{ValueType::code8, 255};
  OpenClRenderer renderer(renderer_options(std::nullopt));
  std::vector<std::uint64_t> steps;
  const Validation validation =
      validate(plan, capture, output, renderer, 2, [&](std::uint64_t done, std::uint64_t total) {
        steps.push_back(done);
        EXPECT_EQ(total, 1 + 4 * renderer.precisions().size());
      });
  EXPECT_EQ(steps.size(), 1 + 4 * renderer.precisions().size());
  EXPECT_TRUE(validation.is_within_bounds());
  EXPECT_GT(validation.reference_ms, 0.0);
  ASSERT_EQ(validation.variants.size(), renderer.precisions().size());
  EXPECT_EQ(validation.variants[validation.chosen].precision(),
            choose_precision(plan, output, renderer.precisions()).precision());

  const Picture expected = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
  const Picture expected_codes = ReferenceRenderer().render(plan, capture, output).picture;
  std::uint64_t payload_bytes = 0;
  for (const PlannedBlock& block : plan.blocks) payload_bytes += capture.view(block.block).payload().size();
  for (const ValidatedVariant& variant : validation.variants) {
    SCOPED_TRACE(to_text(variant.precision()));
    OpenClRenderer own(renderer_options(variant.precision()));
    const Picture light = own.render(plan, capture, {ValueType::light64, 0}).picture;
    long double squares = 0;
    double worst = 0;
    for (std::uint64_t i = 0; i < light.shape.value_count(); ++i) {
      const double error = std::fabs(light.values<double>()[i] - expected.values<double>()[i]);
      squares += static_cast<long double>(error) * error;
      worst = std::max(worst, error);
    }
    EXPECT_EQ(variant.light.worst, worst);
    EXPECT_NEAR(variant.light.rms,
                static_cast<double>(std::sqrt(squares / static_cast<long double>(light.shape.value_count()))),
                1e-9 * worst);
    EXPECT_EQ(variant.light.share_of_bound, share_of_bound(plan, variant.precision(), light, expected).worst);
    const Picture codes = own.render(plan, capture, output).picture;
    std::uint64_t differing = 0;
    for (std::size_t i = 0; i < codes.bytes.size(); ++i)
      differing += codes.bytes[i] != expected_codes.bytes[i];
    EXPECT_EQ(variant.stored.differing, differing);
    EXPECT_EQ(variant.stored.values, light.shape.value_count());
    EXPECT_EQ(variant.payload_bytes, payload_bytes);
    EXPECT_GT(variant.expose_ms, 0.0);
    EXPECT_GT(variant.develop_ms, 0.0);
    EXPECT_GT(variant.render_ms, variant.expose_ms);
    EXPECT_NEAR(variant.gigabytes_per_second(), static_cast<double>(payload_bytes) * 1e-6 / variant.expose_ms,
                1e-9);
  }
}

TEST(Validation, OneVariantBeyondItsBoundIsEnough) {
  Validation validation;
  validation.variants.resize(3);
  EXPECT_TRUE(validation.is_within_bounds());
  validation.variants[1].light.share_of_bound = 1.01;
  EXPECT_FALSE(validation.is_within_bounds());
  validation.variants[1].light.share_of_bound = 1.0;
  EXPECT_TRUE(validation.is_within_bounds());
  validation.variants[2].stored = {100, 2, 1};
  EXPECT_FALSE(validation.is_within_bounds());
}

}  // namespace
}  // namespace nutik::test
