// Every arithmetic that the device has, on hard cases: within its computed bound of the reference, whatever kind
// tiles are of and however long blocks are.
#include "support/hard_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "imev/each_block.hpp"
#include "opencl/allocation_cuts.hpp"
#include "render/reference_renderer.hpp"
#include "support/precision_check.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

// A case with its blocks and tiles as they are, or laid out another way.
struct Layout {
  const HardCase& hard;
  std::uint32_t block_samples;
  TilePolicy policy;

  explicit Layout(const HardCase& each)
      : hard(each), block_samples(each.block_samples), policy(each.policy) {}
  Layout(const HardCase& each, std::uint32_t samples, TilePolicy tiles)
      : hard(each), block_samples(samples), policy(tiles) {}

  [[nodiscard]] RenderPlan plan() const {
    return make_plan(hard.open(block_samples, policy), hard.functions, hard.mask, {});
  }
  [[nodiscard]] Rendered rendered(Renderer& renderer, const RenderPlan& plan,
                                  const OutputFormat& output) const {
    StreamingCapture capture = hard.open(block_samples, policy);
    return renderer.render(plan, capture, output);
  }
  [[nodiscard]] Picture render(Renderer& renderer, const RenderPlan& plan, const OutputFormat& output) const {
    return rendered(renderer, plan, output).picture;
  }
};

class HardCases : public testing::TestWithParam<NamedHardCase> {
 protected:
  const HardCase hard_ = GetParam().make();
};

TEST_P(HardCases, StayWithinTheBoundOfEveryPrecision) {
  const Layout layout(hard_);
  const RenderPlan plan = layout.plan();
  PrecisionCheck check;
  check.check(
      plan, [&](Renderer& renderer, const OutputFormat& output) { return layout.render(renderer, plan, output); },
      GetParam().name, rerun());
  std::printf("%s\n", GetParam().reason);
  check.print();
}

// What is chosen keeps the format within half a step beside its own rounding, or says that nothing does.
TEST_P(HardCases, AreRightInTheArithmeticThatIsChosen) {
  const Layout layout(hard_);
  const RenderPlan plan = layout.plan();
  const OutputFormat output = codes_like(plan.capture);
  OpenClRenderer renderer(renderer_options({}));
  const Rendered rendered = layout.rendered(renderer, plan, output);
  const Picture& codes = rendered.picture;
  const PrecisionChoice& choice = *rendered.choice;
  std::printf("%s, within %.3g codes\n", to_text(choice.precision()).c_str(), choice.bound.worst.steps);
  if (!choice.is_right_enough()) {
    EXPECT_FALSE(rendered.warnings.empty());
    return;
  }
  ReferenceRenderer reference;
  const Picture expected = layout.render(reference, plan, output);
  for (std::uint64_t i = 0; i < codes.shape.value_count(); ++i) {
    const auto code = [&](const Picture& picture) {
      return output.type == ValueType::code8 ? picture.values<std::uint8_t>()[i]
                                             : picture.values<std::uint16_t>()[i];
    };
    ASSERT_LE(std::abs(code(codes) - code(expected)), 1)
        << to_text(choice.precision()) << ", value " << i << "; rerun: " << rerun();
  }
}

// Tiles of any kind in blocks of any length hold the same capture: the same bytes in whole numbers, within the
// bound otherwise.
TEST_P(HardCases, DoNotDependOnTilesOrBlocks) {
  const OutputFormat as_light{ValueType::light64, 0};
  const Layout usual(hard_, 64, TilePolicy::automatic);
  const RenderPlan plan = usual.plan();
  ReferenceRenderer reference;
  const Picture expected = usual.render(reference, plan, as_light);
  constexpr std::pair<std::uint32_t, TilePolicy> kLayouts[] = {
      {1, TilePolicy::automatic}, {2, TilePolicy::records},  {7, TilePolicy::rows},
      {64, TilePolicy::dense},    {64, TilePolicy::records}, {300, TilePolicy::automatic}};
  PrecisionCheck renderers;
  for (const Precision precision : renderers.precisions()) {
    OpenClRenderer& renderer = renderers.of(precision);
    const Picture first = usual.render(renderer, plan, as_light);
    for (const auto& [block_samples, policy] : kLayouts) {
      const Layout other(hard_, block_samples, policy);
      const RenderPlan other_plan = other.plan();
      const Picture light = other.render(renderer, other_plan, as_light);
      const Difference share = share_of_bound(other_plan, precision, light, expected);
      ASSERT_LE(share.worst, 1.0) << to_text(precision) << ", blocks of " << block_samples << ", tiles "
                                  << to_text(policy) << ", value " << share.value << "; rerun: " << rerun();
      if (precision != Precision::fixed) continue;
      ASSERT_TRUE(light.bytes == first.bytes)
          << "blocks of " << block_samples << ", tiles " << to_text(policy) << "; rerun: " << rerun();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, HardCases, testing::ValuesIn(hard_cases().begin(), hard_cases().end()),
                         [](const auto& instance) { return instance.param.name; });

HardCase hard_case(const std::string& name) {
  const auto cases = hard_cases();
  const auto named =
      std::ranges::find_if(cases, [&](const NamedHardCase& each) { return each.name == name; });
  if (named == cases.end()) throw std::logic_error("there is no hard case " + name);
  return named->make();
}

// With as many bytes at a time as tools/check_kernels allows for it; in one chunk, for Oclgrind does not bear a second
// thread that copies the next one.
TEST(LargerThanAnAllocation, IsCutIntoBands) {
  const HardCase hard = hard_case("LargerThanAnAllocation");
  const Layout layout(hard);
  const RenderPlan plan = layout.plan();
  for (const Precision precision : first_precisions()) {
    OpenClOptions options = renderer_options(precision);
    options.allocation_bytes = 5000;
    const std::uint64_t bands = cut_picture(plan.capture.shape, Rectangle::whole(plan.capture.shape), precision,
                                            device_allocating(options.allocation_bytes))
                                    .size();
    EXPECT_GE(bands, 2u) << to_text(precision);
    OpenClRenderer small(options), plain(renderer_options(precision));
    const OutputFormat codes = codes_like(plan.capture);
    const Rendered cut = layout.rendered(small, plan, codes);
    EXPECT_EQ(cut.picture.bytes, layout.render(plain, plan, codes).bytes) << to_text(precision);
    EXPECT_EQ(cut.statistics.launches, bands) << to_text(precision);
  }
}

TEST(TilesOfAllKinds, AreInTheCaseOfThatName) {
  const HardCase hard = hard_case("TilesOfAllKinds");
  StreamingCapture capture = hard.open();
  BlockCursor cursor(capture);
  const BlockView block = cursor.at(0);
  std::vector<TileKind> kinds;
  for (std::uint64_t tile = 0; tile < 4; ++tile) {
    kinds.push_back(block.geometry().kind_of(block.entry(tile)));
  }
  EXPECT_EQ(kinds, (std::vector{TileKind::still, TileKind::rows, TileKind::dense, TileKind::records}));
}

}  // namespace
}  // namespace nutik::test
