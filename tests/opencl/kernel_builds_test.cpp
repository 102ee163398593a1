// The kernels as the host can ask for them, each build against the reference within its bound: the output that it is
// built for, and light, where every rounding shows.
//
// NUTIK_TEST_BUILDS=all builds all that there are (tools/check_kernel_builds), NUTIK_TEST_BUILDS=name the one of that
// name; by default few of them, in which any two values meet.
#include "support/kernel_builds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "capture/format.hpp"
#include "opencl/opencl_api.hpp"
#include "render/reference_renderer.hpp"
#include "support/bound_share.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

// What the first device cannot be asked for.
constexpr Exclusion kAbsent[] = {
    {"the device has no double",
     [](const KernelBuild& build) {
       return build.precision == Precision::double_ && !list_devices().front().has_double;
     }},
    {"the device does not fuse floats",
     [](const KernelBuild& build) {
       return build.fuses && build.precision != Precision::double_ &&
              (all_devices().front().getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_FMA) == 0;
     }},
    {"the device does not fuse doubles",
     [](const KernelBuild& build) {
       return build.fuses && build.precision == Precision::double_ &&
              (all_devices().front().getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() & CL_FP_FMA) == 0;
     }},
};

// A capture that meets all of the kernels' ways: 17 tiles that are still, rows, dense and records, under one function
// and under several; a block whose samples are counted in 16 bits and one with 8; gains of both signs, and one that
// lives in the second block only.
class BuildScene {
 public:
  static constexpr std::uint64_t kSamples = 300;
  static constexpr std::uint32_t kBlockSamples = 260;

  explicit BuildScene(const KernelBuild& build)
      : capture_(capture_of(build)),
        plan_(make_plan(capture_, functions(), mask(), {})),
        light_(ReferenceRenderer().render(plan_, capture_, {ValueType::light64, 0}).picture) {}

  [[nodiscard]] MemoryCapture& capture() { return capture_; }
  [[nodiscard]] const RenderPlan& plan() const { return plan_; }
  // The reference's.
  [[nodiscard]] const Picture& light() const { return light_; }

 private:
  static constexpr std::uint32_t kWidth = 130, kHeight = 3;
  static constexpr std::int64_t kPeriodNs = 1'000'000;

  static std::uint32_t tile_of(std::size_t pixel) { return static_cast<std::uint32_t>(pixel % kWidth / 8); }

  static MemoryCapture capture_of(const KernelBuild& build) {
    const CaptureFormat format{.shape = {kWidth, kHeight, build.channels},
                               .code_bytes = build.code_bytes,
                               .white_code = build.code_bytes == 1 ? 255u : 4095u,
                               .transfer = build.transfer()};
    Random random(11);
    Rasters rasters;
    std::vector<std::byte> raster(format.sample_bytes());
    for (std::uint64_t k = 0; k < kSamples; ++k) {
      for (std::uint64_t pixel = 0; pixel < format.shape.pixel_count(); ++pixel) {
        const bool changes[] = {false, k % 40 == 7, true, random.chance(0.02)};
        if (k > 0 && !changes[tile_of(pixel) % 4]) continue;
        for (std::uint32_t channel = 0; channel < build.channels; ++channel) {
          const auto code = static_cast<std::uint32_t>(random.whole(0, format.white_code));
          set_code(format, raster, pixel * build.channels + channel, code);
        }
      }
      rasters.push_back(raster);
    }
    return {format, Timeline::constant({1'000'000'000, kPeriodNs}, {180, 1}, kSamples), rasters,
            kBlockSamples};
  }

  static FunctionSet functions() {
    const std::int64_t second_block_ns = kBlockSamples * kPeriodNs;
    return {{0, GainFunction({{0, 1.0}, {90'500'000, 0.3}, {240'000'000, 2.0}})},
            {1, GainFunction({{1'200'000, 0.0}, {70'000'001, 1.5}, {70'000'001, -0.8}, {280'000'000, 0.1}})},
            {2, GainFunction::boxcar(second_block_ns + 5'300'000, second_block_ns + 17'000'000, -0.7)}};
  }

  // The first tiles each under one function, the others pixel by pixel.
  static Mask mask() {
    Mask mask = Mask::uniform(kWidth, kHeight, 0);
    for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
      const std::uint32_t tile = tile_of(pixel);
      mask.tags[pixel] = static_cast<std::uint8_t>((tile < 9 ? tile : pixel) % 3);
    }
    return mask;
  }

  MemoryCapture capture_;
  RenderPlan plan_;
  Picture light_;
};

BuildScene& scene_for(const KernelBuild& build) {
  static std::map<std::tuple<std::string, std::uint32_t, std::uint32_t>, std::unique_ptr<BuildScene>> scenes;
  std::unique_ptr<BuildScene>& scene = scenes[{build.transfer().text(), build.code_bytes, build.channels}];
  if (scene == nullptr) scene = std::make_unique<BuildScene>(build);
  return *scene;
}

std::string wanted_builds() {
  const char* wanted = std::getenv("NUTIK_TEST_BUILDS");
  return wanted == nullptr ? "" : wanted;
}

// What this run builds of a precision.
std::vector<KernelBuild> builds_of(Precision precision) {
  std::vector<KernelBuild> builds = possible_builds();
  const std::string wanted = wanted_builds();
  if (wanted.empty()) builds = pairwise(builds);
  std::erase_if(builds, [&](const KernelBuild& build) {
    return build.precision != precision || (!wanted.empty() && wanted != "all" && build.name() != wanted);
  });
  return builds;
}

class KernelBuilds : public testing::TestWithParam<Precision> {};

TEST_P(KernelBuilds, StayWithinTheirBounds) {
  const std::vector<KernelBuild> builds = builds_of(GetParam());
  std::string worst_name;
  double worst = 0.0;
  std::size_t built = 0, number = 0;
  std::map<std::string, std::size_t> absent;
  for (const KernelBuild& build : builds) {
    ++number;
    const auto* const reason =
        std::ranges::find_if(kAbsent, [&](const Exclusion& each) { return each.applies(build); });
    if (reason != std::end(kAbsent)) {
      ++absent[reason->reason];
      continue;
    }
    SCOPED_TRACE(build.name() + "; rerun: NUTIK_TEST_BUILDS=" + build.name() + " " + rerun());
    OpenClRenderer renderer(build.options());
    BuildScene& scene = scene_for(build);
    double most = 0.0;
    for (const OutputFormat& output : {build.output, OutputFormat{ValueType::light64, 0}}) {
      const ErrorBound bound = error_bound(scene.plan(), build.precision, output);
      const Picture picture = renderer.render(scene.plan(), scene.capture(), output).picture;
      const Difference share = share_of_bound(scene.plan(), bound, output, picture, scene.light());
      EXPECT_LE(share.worst, 1.0) << "of the bound, at value " << share.value << ", light "
                                  << scene.light().values<double>()[share.value];
      most = std::max(most, share.worst);
    }
    std::printf("%zu of %zu: %s, %.3g of its bound\n", number, builds.size(), build.name().c_str(), most);
    std::fflush(stdout);
    ++built;
    if (most > worst) {
      worst = most;
      worst_name = build.name();
    }
  }
  for (const auto& [reason, count] : absent) {
    std::printf("%s: NOT TESTED: %zu builds: %s\n", to_text(GetParam()).c_str(), count, reason.c_str());
  }
  std::printf("%s: %zu builds, at most %.3g of the bound: %s\n", to_text(GetParam()).c_str(), built, worst,
              worst_name.c_str());
}

INSTANTIATE_TEST_SUITE_P(, KernelBuilds, testing::ValuesIn(kPrecisions),
                         [](const auto& instance) { return to_text(instance.param); });

// The few builds are enough, and what no build has is left out for a reason that is told.
TEST(KernelBuildTable, MeetsAnyTwoValues) {
  const std::vector<KernelBuild> possible = possible_builds();
  const std::vector<KernelBuild> few = pairwise(possible);
  const auto pairs_of = [](const std::vector<KernelBuild>& builds) {
    std::set<std::pair<std::string, std::string>> pairs;
    for (const KernelBuild& build : builds) {
      const std::vector<std::string> values = values_of(build);
      for (std::size_t a = 0; a < values.size(); ++a) {
        for (std::size_t b = a + 1; b < values.size(); ++b) pairs.emplace(values[a], values[b]);
      }
    }
    return pairs;
  };
  const auto met = pairs_of(few);
  EXPECT_EQ(met, pairs_of(possible));
  EXPECT_LE(few.size(), 60u);
  for (const Precision precision : kPrecisions) {
    EXPECT_TRUE(std::ranges::any_of(few, [&](const KernelBuild& build) {
      return build.precision == precision && build.lanes == 4 && build.item_pixels == 4 &&
             build.item_tiles == 1;
    })) << to_text(precision);
  }

  const std::vector<KernelBuild> all = all_combinations();
  std::printf(
      "%zu builds for %zu pairs of values, out of %zu possible ones; of %zu combinations there are no\n",
      few.size(), met.size(), possible.size(), all.size());
  for (const Exclusion& exclusion : kernel_build_exclusions()) {
    std::printf("  %6zu: %s\n", static_cast<std::size_t>(std::ranges::count_if(all, exclusion.applies)),
                exclusion.reason);
  }
  for (const auto& [a, b] : pairs_of(all)) {
    if (!met.contains({a, b})) std::printf("  no build has %s and %s\n", a.c_str(), b.c_str());
  }
}

TEST(KernelBuildTable, IsTriedOnTilesOfAllKinds) {
  BuildScene& scene = scene_for(possible_builds().front());
  for (std::uint64_t b = 0; b < scene.capture().block_count(); ++b) {
    const BlockView block = scene.capture().view(b);
    std::set<TileKind> kinds;
    for (std::uint64_t tile = 0; tile < 17; ++tile) kinds.insert(block.geometry().kind_of(block.entry(tile)));
    EXPECT_EQ(kinds.size(), 4u) << "block " << b;
  }
}

}  // namespace
}  // namespace nutik::test
