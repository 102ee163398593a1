// Light to codes by another function than the capture's, in every arithmetic, each within its bound of what the
// reference's light comes to by the standards' own words (support/bound_share.cpp).
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "render/reference_renderer.hpp"
#include "support/bound_share.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

const Transfer kCaptures[] = {Transfer::srgb(),     Transfer::bt709(), Transfer::linear(),
                              Transfer::gamma(2.2), Transfer::hlg(),   Transfer::pq()};
const std::optional<Transfer> kOutputs[] = {Transfer::srgb(),     Transfer::bt709(),  Transfer::linear(),
                                            Transfer::gamma(1.8), Transfer::gamma(6), std::nullopt};

TEST(OutTransfer, IsWithinTheBoundInEveryArithmetic) {
  ReferenceRenderer reference;
  std::map<Precision, double> worst;
  std::map<Precision, std::unique_ptr<OpenClRenderer>> renderers;
  for (const Precision precision : first_precisions()) {
    renderers[precision] = std::make_unique<OpenClRenderer>(renderer_options(precision));
  }
  std::uint64_t seed = 100;
  for (const Transfer& transfer : kCaptures) {
    for (const Primaries primaries : {Primaries::bt709, Primaries::bt2020, Primaries::p3}) {
      const bool is_deep = ++seed % 2 == 0;
      RandomCase random(seed, {3, is_deep ? 2u : 1u, is_deep ? 4095u : 255u, transfer});
      random.capture.primaries = primaries;
      MemoryCapture capture = random.encode();
      const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
      const Picture light = reference.render(plan, capture, {ValueType::light64, 0}).picture;
      for (const std::optional<Transfer>& out : kOutputs) {
        for (const OutputFormat& output :
             {OutputFormat{ValueType::code8, 255, NegativeLight::saturate, out},
              OutputFormat{ValueType::code16, 65'535, NegativeLight::saturate, out}}) {
          for (auto& [precision, renderer] : renderers) {
            SCOPED_TRACE(random.text() + " " + std::string(to_text(primaries)) + " as " +
                         (out ? out->text() : "its own") + " in " + to_text(precision));
            const ErrorBound bound = error_bound(plan, precision, output);
            const Rendered rendered = renderer->render(plan, capture, output);
            const Difference share = share_of_bound(plan, bound, output, rendered.picture, light);
            EXPECT_LE(share.worst, 1.0) << "of the bound, at value " << share.value;
            worst[precision] = std::max(worst[precision], share.worst);
            EXPECT_EQ(rendered.picture.transfer, out ? *out : transfer);
            EXPECT_EQ(rendered.picture.primaries, out ? Primaries::bt709 : primaries);
          }
          // The reference's own codes have no bound but that of their light.
          const Picture codes = reference.render(plan, capture, output).picture;
          ErrorBound bound = error_bound(plan, Precision::double_, output);
          EXPECT_LE(share_of_bound(plan, bound, output, codes, light).worst, 1.0);
        }
      }
    }
  }
  for (const auto& [precision, share] : worst) {
    std::printf("%-11s at most %.3g of its bound\n", to_text(precision).c_str(), share);
  }
}

// What is as bright as white on paper is as bright as white on a screen.
TEST(OutTransfer, ShowsReferenceWhiteAsWhite) {
  for (const auto& [transfer, code] :
       {std::pair{Transfer::hlg(), 0.75 * 65'535}, {Transfer::pq(), 0.58069 * 65'535}}) {
    const CaptureFormat format{.shape = {1, 1, 3},
                               .code_bytes = 2,
                               .white_code = 65'535,
                               .transfer = transfer,
                               .primaries = Primaries::bt2020};
    std::vector<std::byte> raster(format.sample_bytes());
    for (std::uint64_t i = 0; i < 3; ++i) {
      set_code(format, raster, i, static_cast<std::uint32_t>(code + 0.5));
    }
    const Rasters rasters{raster};
    MemoryCapture capture(format, Timeline::constant({10, 1}, Timeline::kFullShutter, 1), rasters, 1);
    const RenderPlan plan =
        make_plan(capture, {{0, GainFunction::boxcar(0, 100'000'000)}}, Mask::uniform(1, 1, 0), {});
    OpenClRenderer renderer(renderer_options(std::nullopt));
    const Rendered shown =
        renderer.render(plan, capture, {ValueType::code8, 255, NegativeLight::saturate, Transfer::srgb()});
    for (const std::uint8_t value : shown.picture.values<std::uint8_t>()) {
      EXPECT_EQ(value, 255) << transfer.text();
    }
    EXPECT_EQ(shown.saturation, Saturation{});
  }
}

// Kernels tell codes apart by one comparison, which those of a steep function need more than; the host makes them.
TEST(OutTransfer, MakesCodesThatLieCloseTogetherOnTheHost) {
  const RandomCase random(7, {1, 2, 65'535, Transfer::gamma(9)});
  MemoryCapture capture = random.encode();
  const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
  const OutputFormat output{ValueType::code16, 65'535};
  ReferenceRenderer reference;
  const Picture light = reference.render(plan, capture, {ValueType::light64, 0}).picture;
  for (const Precision precision : first_precisions()) {
    OpenClRenderer renderer(renderer_options(precision));
    const Picture picture = renderer.render(plan, capture, output).picture;
    const ErrorBound bound = error_bound(plan, precision, output);
    EXPECT_LE(share_of_bound(plan, bound, output, picture, light).worst, 1.0) << to_text(precision);
  }
}

}  // namespace
}  // namespace nutik::test
