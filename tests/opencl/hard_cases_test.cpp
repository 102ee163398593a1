// Every arithmetic that the device has, on hard cases and on random ones: within its computed bound of the
// reference, whatever kind tiles are of and however long blocks are.
//
// For tools/check_kernels, which runs these under a simulator:
//
//   NUTIK_TEST_RENDER=fixed,codes     only this arithmetic, and only codes or light: one render in a process
//   NUTIK_TEST_LARGEST=n              of the random cases only those of at most n values in all samples
//   NUTIK_TEST_PICTURES=folder        keeps the pictures of `fixed`, to be compared with another device's
#include "support/hard_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string_view>

#include "capture/format.hpp"
#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"

namespace nutik {
namespace {

using test::Difference;
using test::HardCase;
using test::NamedHardCase;
using test::RandomCase;

// What NUTIK_TEST_RENDER leaves to be rendered.
bool is_wanted(std::string_view name) {
  const char* wanted = std::getenv("NUTIK_TEST_RENDER");
  if (wanted == nullptr) return true;
  const std::string list = std::string(",") + wanted + ",";
  return list.find("," + std::string(name) + ",") != std::string::npos;
}

// A renderer for each arithmetic that the device has.
class Renderers {
 public:
  Renderers() {
    for (const Precision precision : precisions_of(list_devices().front())) {
      if (!is_wanted(to_text(precision))) continue;
      precisions_.push_back(precision);
      renderers_.emplace(precision, std::make_unique<OpenClRenderer>(test::renderer_options(precision)));
    }
  }
  [[nodiscard]] const std::vector<Precision>& precisions() const { return precisions_; }
  [[nodiscard]] OpenClRenderer& of(Precision precision) { return *renderers_.at(precision); }

 private:
  std::vector<Precision> precisions_;
  std::map<Precision, std::unique_ptr<OpenClRenderer>> renderers_;
};

OutputFormat own_codes(const CaptureFormat& capture) {
  return {capture.code_bytes == 1 ? ValueType::code8 : ValueType::code16, capture.white_code};
}

std::uint32_t code_of(const Picture& picture, std::uint64_t i) {
  return picture.type == ValueType::code8 ? picture.values<std::uint8_t>()[i]
                                          : picture.values<std::uint16_t>()[i];
}

// How far the codes of a picture lie from where the reference's light lies on the scale of codes, beyond the half
// that rounding costs and in what error_bound() allows: at most 1. The place itself is computed to 32 u₆₄ of
// the scale.
Difference share_of_steps(const RenderPlan& plan, const ErrorBound& bound, const Picture& codes,
                          const Picture& light) {
  Difference difference;
  for (std::uint64_t i = 0; i < codes.shape.value_count(); ++i) {
    const double inside = std::clamp(light.values<double>()[i], 0.0, 1.0);
    const double place = plan.capture.transfer.fraction_of(inside) * codes.white_code;
    const std::size_t f = plan.function_of_pixel[i / codes.shape.channels];
    const double allowed = bound.functions[f].steps + 32 * test::kRoundoff64 * codes.white_code;
    const double beyond = std::fabs(code_of(codes, i) - place) - 0.5;
    if (beyond / allowed > difference.worst) difference = {beyond / allowed, i};
  }
  return difference;
}

// Something that can be rendered over and over: a hard case or a random one.
struct Scene {
  std::function<RenderPlan()> plan;
  std::function<Picture(Renderer& renderer, const RenderPlan& plan, const OutputFormat& output)> render;
};

Scene scene_of(const HardCase& hard, std::uint32_t block_samples, TilePolicy policy) {
  return {[=] { return make_plan(hard.open(block_samples, policy), hard.functions, hard.mask, {}); },
          [=](Renderer& renderer, const RenderPlan& plan, const OutputFormat& output) {
            StreamingCapture capture = hard.open(block_samples, policy);
            return renderer.render(plan, capture, output);
          }};
}

// Keeps a picture that must be the same on every device.
void keep(const Picture& picture, const std::string& name) {
  const char* folder = std::getenv("NUTIK_TEST_PICTURES");
  if (folder == nullptr) return;
  std::ofstream file(std::filesystem::path(folder) / name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(picture.bytes.data()),
             static_cast<std::streamsize>(picture.bytes.size()));
  ASSERT_TRUE(file.good()) << name << " cannot be written to " << folder;
}

// One arithmetic against the reference's light, in light and in codes. Returns the worst difference in light, as a
// share of the bound.
double expect_within_bound(const Scene& scene, const RenderPlan& plan, const Picture& expected,
                           OpenClRenderer& renderer, Precision precision, const std::string& name,
                           const std::string& rerun) {
  Difference share;
  if (is_wanted("light")) {
    const OutputFormat output{ValueType::light64, 0};
    const Picture light = scene.render(renderer, plan, output);
    share = test::share_of_bound(plan, error_bound(plan, precision, output), light, expected);
    EXPECT_LE(share.worst, 1.0) << name << ", " << to_text(precision) << ", value " << share.value << ": "
                                << light.values<double>()[share.value] << " and "
                                << expected.values<double>()[share.value] << "; rerun: " << rerun;
    if (precision == Precision::fixed) keep(light, name + ".light");
  }
  if (is_wanted("codes")) {
    const OutputFormat output = own_codes(plan.capture);
    const Picture codes = scene.render(renderer, plan, output);
    const Difference steps = share_of_steps(plan, error_bound(plan, precision, output), codes, expected);
    EXPECT_LE(steps.worst, 1.0) << name << ", " << to_text(precision) << ", value " << steps.value
                                << ": code " << code_of(codes, steps.value) << " for light "
                                << expected.values<double>()[steps.value] << "; rerun: " << rerun;
    if (precision == Precision::fixed) keep(codes, name + ".codes");
  }
  return share.worst;
}

class HardCases : public testing::TestWithParam<NamedHardCase> {};

TEST_P(HardCases, StayWithinTheBoundOfEveryPrecision) {
  const HardCase hard = GetParam().make();
  const Scene scene = scene_of(hard, hard.block_samples, hard.policy);
  const RenderPlan plan = scene.plan();
  ReferenceRenderer reference;
  const Picture expected = scene.render(reference, plan, {ValueType::light64, 0});
  std::printf("%s (%s):", GetParam().name, GetParam().reason);
  Renderers renderers;
  for (const Precision precision : renderers.precisions()) {
    const double share = expect_within_bound(scene, plan, expected, renderers.of(precision), precision,
                                             GetParam().name, test::rerun());
    std::printf(" %s %.3g", to_text(precision).c_str(), share);
  }
  std::printf(" of the bound\n");
}

// What is picked by itself errs by half a step at most, beside the rounding, unless it says that nothing does.
TEST_P(HardCases, AreRightInTheArithmeticThatIsChosen) {
  const HardCase hard = GetParam().make();
  const Scene scene = scene_of(hard, hard.block_samples, hard.policy);
  const RenderPlan plan = scene.plan();
  ReferenceRenderer reference;
  const Picture expected = scene.render(reference, plan, {ValueType::light64, 0});
  OpenClRenderer renderer(test::renderer_options({}));
  const Picture codes = scene.render(renderer, plan, own_codes(plan.capture));
  const ErrorBound& bound = renderer.choice().bound;
  const Difference steps = share_of_steps(plan, bound, codes, expected);
  EXPECT_LE(steps.worst, 1.0) << to_text(bound.precision) << ", value " << steps.value << ": code "
                              << code_of(codes, steps.value) << " for light "
                              << expected.values<double>()[steps.value] << "; rerun: " << test::rerun();
  EXPECT_EQ(renderer.choice().is_right_enough(), bound.worst.steps <= kMostSteps);
  std::printf("%s: %s, bound %.3g steps\n", GetParam().name, to_text(bound.precision).c_str(),
              bound.worst.steps);
}

// Tiles of any kind in blocks of any length hold the same capture: the same bytes in whole numbers, within the
// bound otherwise.
TEST_P(HardCases, DoNotDependOnTilesOrBlocks) {
  const HardCase hard = GetParam().make();
  const Scene scene = scene_of(hard, 64, TilePolicy::automatic);
  const RenderPlan plan = scene.plan();
  ReferenceRenderer reference;
  const Picture expected = scene.render(reference, plan, {ValueType::light64, 0});
  constexpr std::pair<std::uint32_t, TilePolicy> kLayouts[] = {
      {1, TilePolicy::automatic}, {2, TilePolicy::records},  {7, TilePolicy::rows},
      {64, TilePolicy::dense},    {64, TilePolicy::records}, {300, TilePolicy::automatic}};
  Renderers renderers;
  for (const Precision precision : renderers.precisions()) {
    OpenClRenderer& renderer = renderers.of(precision);
    const Picture fixed = scene.render(renderer, plan, {ValueType::light64, 0});
    for (const auto& [block_samples, policy] : kLayouts) {
      const Scene other = scene_of(hard, block_samples, policy);
      const RenderPlan other_plan = other.plan();
      const Picture light = other.render(renderer, other_plan, {ValueType::light64, 0});
      const Difference share = test::share_of_bound(other_plan, precision, light, expected);
      ASSERT_LE(share.worst, 1.0) << to_text(precision) << ", blocks of " << block_samples << ", tiles "
                                  << to_text(policy) << ", value " << share.value
                                  << "; rerun: " << test::rerun();
      if (precision != Precision::fixed) continue;
      ASSERT_EQ(light.bytes, fixed.bytes)
          << "blocks of " << block_samples << ", tiles " << to_text(policy) << "; rerun: " << test::rerun();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, HardCases, testing::ValuesIn(test::hard_cases().begin(), test::hard_cases().end()),
                         [](const auto& instance) { return instance.param.name; });

TEST(HardCase, TilesOfAllKindsHasThem) {
  const auto cases = test::hard_cases();
  const auto named = std::ranges::find_if(
      cases, [](const NamedHardCase& each) { return std::string(each.name) == "TilesOfAllKinds"; });
  ASSERT_NE(named, cases.end());
  const HardCase hard = named->make();
  StreamingCapture capture = hard.open();
  std::vector<std::byte> payload(capture.prepare(0));
  capture.read(0, payload);
  const BlockView block(hard.capture, capture.block_extent(0), payload);
  std::vector<TileKind> kinds;
  for (std::uint64_t tile = 0; tile < 4; ++tile) kinds.push_back(block.geometry().kind_of(block.entry(tile)));
  EXPECT_EQ(kinds, (std::vector{TileKind::still, TileKind::rows, TileKind::dense, TileKind::records}));
}

// A picture that single precision gets wrong, though nobody would see it in the capture or the functions.
TEST(HardCase, SinglePrecisionIsWrongWhereWhatIsChosenIsRight) {
  const auto cases = test::hard_cases();
  const auto named = std::ranges::find_if(cases, [](const NamedHardCase& each) {
    return std::string(each.name) == "CancelsToABillionthOnAStillScene";
  });
  ASSERT_NE(named, cases.end());
  const HardCase hard = named->make();
  const Scene scene = scene_of(hard, hard.block_samples, hard.policy);
  const RenderPlan plan = scene.plan();
  ReferenceRenderer reference;
  const Picture right = scene.render(reference, plan, {ValueType::code8, 255});
  const auto worst_code = [&](std::optional<Precision> precision) {
    OpenClRenderer renderer(test::renderer_options(precision));
    const Picture picture = scene.render(renderer, plan, {ValueType::code8, 255});
    int worst = 0;
    for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
      worst = std::max(worst, std::abs(picture.values<std::uint8_t>()[i] - right.values<std::uint8_t>()[i]));
    }
    return worst;
  };
  EXPECT_GT(worst_code(Precision::single_), 1);
  EXPECT_EQ(worst_code({}), 0);
}

TEST(RandomCases, StayWithinTheBoundOfEveryPrecision) {
  // A kernel is built for each, so these few.
  const test::CodeFormat formats[] = {{1, 1, 255, Transfer::srgb()},
                                      {1, 2, 65'535, Transfer::bt709()},
                                      {1, 2, 4095, Transfer::linear()},
                                      {1, 1, 255, Transfer::gamma(2.2)},
                                      {3, 1, 255, Transfer::bt709()}};
  const test::Seeds seeds = test::seeds(10'000, 60);
  const char* limit = std::getenv("NUTIK_TEST_LARGEST");
  const std::uint64_t largest = limit == nullptr ? UINT64_MAX : std::stoull(limit);
  Renderers renderers;
  std::map<Precision, double> worst;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const RandomCase random(seed, formats[seed % std::size(formats)]);
    if (random.capture.shape.value_count() * random.timeline.sample_count() > largest) continue;
    MemoryCapture capture = random.encode();
    const Scene scene{[&] { return make_plan(capture, random.functions, random.mask, {}); },
                      [&](Renderer& renderer, const RenderPlan& plan, const OutputFormat& output) {
                        return renderer.render(plan, capture, output);
                      }};
    const RenderPlan plan = scene.plan();
    ReferenceRenderer reference;
    const Picture expected = scene.render(reference, plan, {ValueType::light64, 0});
    for (const Precision precision : renderers.precisions()) {
      const double share = expect_within_bound(scene, plan, expected, renderers.of(precision), precision,
                                               format("Seed{}", seed), test::rerun(seed));
      worst[precision] = std::max(worst[precision], share);
    }
    if (testing::Test::HasFailure()) {
      std::printf("%s\n", random.text().c_str());
      break;
    }
  }
  for (const auto& [precision, share] : worst) {
    std::printf("%s: at most %.3g of its bound\n", to_text(precision).c_str(), share);
  }
}

}  // namespace
}  // namespace nutik
