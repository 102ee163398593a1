// How many pixels saturate: as many as have light beyond the codes, to what the arithmetic may err by.
#include <gtest/gtest.h>

#include "render/code_scale.hpp"
#include "render/picture_errors.hpp"
#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

using SaturationOf = OfPrecision;

// The pixels of a rectangle that have a channel of which `is_out` holds.
template <typename IsOut>
std::uint64_t count_pixels(const Picture& light, const Rectangle& rectangle, IsOut is_out) {
  std::uint64_t count = 0;
  const auto values = light.values<double>();
  for (std::uint32_t y = rectangle.y; y < rectangle.y + rectangle.height; ++y) {
    for (std::uint32_t x = rectangle.x; x < rectangle.x + rectangle.width; ++x) {
      const std::uint64_t pixel = std::uint64_t{y} * light.shape.width + x;
      const auto of_pixel = values.subspan(pixel * light.shape.channels, light.shape.channels);
      count += std::ranges::any_of(of_pixel, [&](double value) { return is_out(value, pixel); });
    }
  }
  return count;
}

TEST_P(SaturationOf, PixelsIsThatOfTheirLight) {
  OpenClRenderer renderer(renderer_options(GetParam()));
  ReferenceRenderer reference;
  std::uint64_t below = 0, above = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const Transfer& transfer : {Transfer::srgb(), Transfer::linear()}) {
      RandomCase random(seed, {seed % 2 == 0 ? 1u : 3u, 1, 255, transfer});
      MemoryCapture capture = random.encode();
      const std::int64_t middle_ns = capture.timeline().duration_ns() / 2;
      for (auto& [tag, function] : random.functions) {
        if (tag % 3 == 0) function = GainFunction({{0, 2.0 + tag}, {middle_ns, -1.0}});
        if (tag % 3 == 1) function = GainFunction({{0, -0.5}, {middle_ns, -0.5}, {middle_ns, 3.0}});
      }
      const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
      const Picture light = reference.render(plan, capture, {ValueType::light64, 0}).picture;
      for (const OutputFormat& output :
           {OutputFormat{ValueType::code8, 255}, OutputFormat{ValueType::code16, 65'535}}) {
        const CodeScale scale(CodeMaking::of(plan.capture, output).transfer, output);
        const ErrorBound bound = error_bound(plan, GetParam(), output);
        const PixelErrors errors(plan, bound);
        const Shape& shape = plan.capture.shape;
        const Rectangle inner{shape.width / 3, shape.height / 3, (shape.width + 1) / 2,
                              (shape.height + 1) / 2};
        for (const Rectangle& rectangle : {Rectangle::whole(shape), inner}) {
          const Saturation found = renderer.render(plan, capture, output, {.rectangle = rectangle}).saturation;
          const auto between = [&](std::uint64_t count, auto is_out) {
            EXPECT_GE(count, count_pixels(light, rectangle,
                                          [&](double value, std::uint64_t pixel) {
                                            const double error = errors.of(pixel).light;
                                            return is_out(value - error) && is_out(value + error);
                                          }))
                << random.text();
            EXPECT_LE(count, count_pixels(light, rectangle,
                                          [&](double value, std::uint64_t pixel) {
                                            const double error = errors.of(pixel).light;
                                            return is_out(value - error) || is_out(value + error);
                                          }))
                << random.text();
          };
          between(found.below, [&](double value) { return scale.saturates_below(value); });
          between(found.above, [&](double value) { return scale.saturates_above(value); });
          below += found.below;
          above += found.above;
        }
      }
    }
  }
  EXPECT_GT(below, 100u);
  EXPECT_GT(above, 100u);
}

INSTANTIATE_TEST_SUITE_P(, SaturationOf, testing::ValuesIn(kPrecisions),
                         [](const auto& test) { return to_text(test.param); });

}  // namespace
}  // namespace nutik::test
