// Every arithmetic that the device has, against the reference: within its bound, in light and in codes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>

#include "capture/format.hpp"
#include "render/reference_renderer.hpp"
#include "support/precision_check.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"
#include "support/soft_mask.hpp"

namespace nutik::test {
namespace {

class Precisions : public testing::Test {
 protected:
  ~Precisions() override { check_.print(); }

  PrecisionCheck check_;
};

// NUTIK_TEST_CASES=10000 is the full run (docs/explanation/accuracy.md). NUTIK_TEST_LARGEST=n leaves out
// cases of more than n values in all samples together: for tools/check_kernels.
TEST_F(Precisions, StayWithinTheirBoundsOnRandomCases) {
  const char* limit = std::getenv("NUTIK_TEST_LARGEST");
  const std::uint64_t largest = limit == nullptr ? UINT64_MAX : std::stoull(limit);
  const Seeds seeds = test::seeds(0, 300);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const RandomCase random(seed);
    if (random.capture.shape.value_count() * random.timeline.sample_count() > largest) continue;
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    check_.check(plan, capture, format("Seed{}", seed), rerun(seed));
    if (HasFailure()) FAIL() << random.text();
  }
}

// 128 samples at 100 a second in two blocks, random 8-bit codes or a still scene.
MemoryCapture clip_of(const Transfer& transfer, bool is_still, TilePolicy policy = TilePolicy::automatic) {
  const CaptureFormat format{.shape = {19, 9, 1}, .transfer = transfer};
  Random random(7);
  Rasters rasters = random_rasters(random, format, 128);
  if (is_still) std::fill(rasters.begin(), rasters.end(), rasters.front());
  return {format, Timeline::constant({100, 1}, Timeline::kFullShutter, 128), rasters, 64, policy};
}

// `gain` up to the middle of clip_of(), then one that leaves `rest` of it in the mean.
GainFunction cancelling(double gain, double rest) {
  const std::int64_t middle_ns = 640'000'000;
  return GainFunction({{middle_ns, gain}, {middle_ns, 2 * rest - gain}});
}

TEST_F(Precisions, StayWithinTheirBoundsWhereSumsCancel) {
  for (const Transfer& transfer : {Transfer::srgb(), Transfer::linear()}) {
    for (const bool is_still : {true, false}) {
      for (const TilePolicy policy : {TilePolicy::dense, TilePolicy::records}) {
        MemoryCapture capture = clip_of(transfer, is_still, policy);
        for (const double gain : {1e3, 1e6, 1e9, 1e12}) {
          const RenderPlan plan =
              make_plan(capture, {{0, cancelling(gain, 1.0)}}, Mask::uniform(19, 9, 0), {});
          check_.check(plan, capture,
                       format("gains of ±{}, {}, {}, tiles {}", gain, transfer.text(), is_still ? "still" : "moving",
                              to_text(policy)),
                       rerun());
          if (HasFailure()) return;
        }
      }
    }
  }
}

// Where a device does not fuse, products round twice and pairs are multiplied by halves.
TEST_F(Precisions, OfFloatsStayWithinTheirBoundsWithoutFusedProducts) {
  PrecisionCheck without_fma(false);
  MemoryCapture capture = clip_of(Transfer::srgb(), false, TilePolicy::records);
  for (const double gain : {1.0, 1e6}) {
    const RenderPlan plan = make_plan(capture, {{0, cancelling(gain, 0.3)}}, Mask::uniform(19, 9, 0), {});
    without_fma.check(plan, capture, format("gains of ±{} without fma", gain), rerun());
    if (HasFailure()) return;
  }
}

// Gains far beyond what floats hold, and far below; both at once, in functions beside each other.
TEST_F(Precisions, HoldGainsOfAnySize) {
  MemoryCapture capture = clip_of(Transfer::srgb(), false);
  FunctionSet functions;
  std::uint8_t tag = 0;
  for (const double gain : {1.0, -1e300, 1e80, 1e39, 1e20, -1e-20, 1e-40, 1e-80, 1e-300, 5e-324}) {
    functions.emplace(tag++, GainFunction({{0, gain}, {700'000'000, gain / 2}}));
  }
  functions.emplace(tag++, GainFunction({{100'000'000, 1e6}, {400'000'000, 1e-6}, {900'000'000, -1e-6}}));
  Mask mask = Mask::uniform(19, 9, 0);
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    mask.tags[pixel] = static_cast<std::uint8_t>(pixel % tag);
  }
  const RenderPlan plan = make_plan(capture, functions, mask, {});
  check_.check(plan, capture, "gains of all sizes", rerun());
}

// A bound that is never nearly met would say nothing. Gains of one sign, up to 1000 samples.
TEST_F(Precisions, BoundOfSingleIsUseful) {
  Random random(77);
  std::vector<double> shares;
  for (int i = 0; i < 60; ++i) {
    const CaptureFormat format{.shape = {16, 16, 1}, .transfer = i % 2 == 0 ? Transfer::srgb() : Transfer::linear()};
    const auto samples = static_cast<std::uint64_t>(std::exp(random.real(0.0, std::log(1001.0))));
    const Rasters rasters = random_rasters(random, format, samples);
    MemoryCapture capture(format, random_timeline(random, samples), rasters, 64);
    std::vector<ControlPoint> points;
    for (std::int64_t point = 0; point < 5; ++point) {
      points.push_back({capture.timeline().duration_ns() * point / 5, random.real(0.1, 2.0)});
    }
    if (points[1].time_ns == 0) points.resize(1);  // a timeline of some nanoseconds
    const RenderPlan plan = make_plan(capture, {{0, GainFunction(points)}}, Mask::uniform(16, 16, 0), {});
    const Picture light =
        check_.of(Precision::single_).render(plan, capture, {ValueType::light64, 0}).picture;
    const Picture expected = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
    shares.push_back(share_of_bound(plan, Precision::single_, light, expected).worst);
    ASSERT_LE(shares.back(), 1.0) << samples << " samples, case " << i;
  }
  EXPECT_GE(print_shares("single, gains of one sign", shares), 0.01);
}

// Functions without negative gain, exposed to codes of 16 bits: boxcars and lines, cut anywhere; up to 1000 samples,
// from cameras of any transfer function to pictures of another; every fourth mask is soft.
struct BrightCase {
  std::optional<MemoryCapture> capture;
  FunctionSet functions;
  Mask mask = Mask::uniform(16, 16, 0);
  OutputFormat output{ValueType::code16, 65'535};

  explicit BrightCase(std::uint64_t seed) {
    Random random(seed);
    CaptureFormat format;
    format.shape = {16, 16, 1};
    format.transfer = random_transfer(random);
    if (random.chance(0.3)) {
      format.code_bytes = 2;
      format.white_code = static_cast<std::uint32_t>(random.pick(std::vector<int>{1023, 4095, 50'000, 65'535}));
    }
    const auto samples = static_cast<std::uint64_t>(std::exp(random.real(0.0, std::log(1001.0))));
    capture.emplace(format, random_timeline(random, samples), random_rasters(random, format, samples),
                    static_cast<std::uint32_t>(random.whole(8, 64)));
    functions.emplace(0, function(random));
    if (random.chance(0.25)) {
      functions.emplace(1, function(random));
      soften(mask, functions, seed);
    }
    if (random.chance(0.7)) output.transfer = Transfer::srgb();
  }

 private:
  static Transfer random_transfer(Random& random) {
    if (random.chance(0.5)) return Transfer::srgb();
    return random.pick(std::vector<Transfer>{Transfer::linear(), Transfer::bt709(), Transfer::gamma(2.2),
                                             Transfer::gamma(0.6), Transfer::hlg(), Transfer::pq()});
  }
  [[nodiscard]] GainFunction function(Random& random) const {
    const std::int64_t end_ns = capture->timeline().duration_ns();
    const std::int64_t from_ns = random.whole(0, end_ns - 1);
    const double gain = random.chance(0.5) ? 1.0 : std::exp(random.real(-3, 3));
    if (random.chance(0.5)) return GainFunction::boxcar(from_ns, random.whole(from_ns + 1, end_ns), gain);
    std::vector<ControlPoint> points{{random.whole(0, end_ns / 3), gain}};
    while (points.size() < 4) {
      const std::int64_t time_ns = points.back().time_ns + random.whole(0, end_ns / 3);
      points.push_back({time_ns, random.chance(0.2) ? 0.0 : gain * random.real(0, 1)});
      if (points[points.size() - 2].time_ns == time_ns) points.pop_back();
      if (end_ns < 3) break;
    }
    return GainFunction(std::move(points));
  }
};

// What the bound of all light makes of codes.
double whole_steps(const RenderPlan& plan, const ErrorBound& whole, const OutputFormat& output) {
  const Transfer transfer = output.transfer.value_or(plan.capture.transfer);
  const double white = output.transfer ? plan.capture.transfer.reference_white() : 1.0;
  return code_error(transfer, output.white_code, {whole.worst.light / white + 0x1p-24 + 0x1p-49, 0.0});
}

// How far light is from `expected` on the scale of codes, in what its pixel may be.
double share_of_codes(const RenderPlan& plan, const ErrorBound& bound, const Picture& light, const Picture& expected) {
  const Transfer transfer = bound.output.transfer.value_or(plan.capture.transfer);
  const double white = bound.output.transfer ? plan.capture.transfer.reference_white() : 1.0;
  const auto place = [&](double value) {
    return bound.output.white_code * transfer.fraction_of(std::clamp(value / white, 0.0, 1.0));
  };
  const PixelErrors bounds(plan, bound);
  double worst = 0.0;
  for (std::uint64_t i = 0; i < light.shape.value_count(); ++i) {
    const double error = std::fabs(place(light.values<double>()[i]) - place(expected.values<double>()[i]));
    worst = std::max(worst, error == 0.0 ? 0.0 : error / bounds.of(i).steps);
  }
  return worst;
}

// NUTIK_TEST_CASES=10000 is the full run (docs/explanation/accuracy.md).
TEST_F(Precisions, SingleErrsByTheLightItselfWithoutNegativeGain) {
  const Seeds seeds = test::seeds(0, 120);
  std::vector<double> of_codes, of_codes_before, of_light, by_light;
  std::uint64_t chosen = 0, chosen_before = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    BrightCase bright(seed);
    const RenderPlan plan = make_plan(*bright.capture, bright.functions, bright.mask, {});
    Renderer& single = check_.of(Precision::single_);
    const Picture expected = ReferenceRenderer().render(plan, *bright.capture, kLight).picture;
    const Picture light = single.render(plan, *bright.capture, kLight).picture;
    const Picture codes = single.render(plan, *bright.capture, bright.output).picture;
    const ErrorBound bound = error_bound(plan, Precision::single_, bright.output);
    const ErrorBound whole = error_bound(plan, Precision::single_, kLight);
    of_light.push_back(share_of_bound(plan, whole, light, expected).worst);
    by_light.push_back(share_of_bound(plan, bound, kLight, light, expected).worst);
    of_codes.push_back(share_of_codes(plan, bound, light, expected));
    of_codes_before.push_back(of_codes.back() * bound.worst.steps / whole_steps(plan, whole, bright.output));
    ASSERT_LE(of_light.back(), 1.0) << rerun(seed);
    ASSERT_LE(by_light.back(), 1.0) << rerun(seed);
    ASSERT_LE(of_codes.back(), 1.0) << rerun(seed);
    ASSERT_LE(share_of_bound(plan, bound, bright.output, codes, expected).worst, 1.0) << rerun(seed);
    ASSERT_LE(bound.worst.steps, whole_steps(plan, whole, bright.output)) << rerun(seed);
    chosen += bound.worst.steps <= kMaxSteps;
    chosen_before += whole_steps(plan, whole, bright.output) <= kMaxSteps;
  }
  print_shares("single, all light", of_light);
  EXPECT_GE(print_shares("single, by the light itself", by_light), 2 * 0.056);
  const double before = print_shares("single in codes, all light", of_codes_before);
  EXPECT_GE(print_shares("single in codes, by the light", of_codes), 5 * before);
  EXPECT_GT(chosen, 2 * chosen_before);
  std::printf("single is right enough in %llu cases, without the bound by light in %llu\n",
              static_cast<unsigned long long>(chosen), static_cast<unsigned long long>(chosen_before));
}

// The same bytes whatever the size of work-groups, vectors and items, the order and length of blocks, the kind
// of tiles: codes and light.
TEST(FixedPoint, GivesTheSameBytesHoweverTheWorkIsCut) {
  struct Shape {
    std::uint32_t item_pixels, item_tiles, lanes;
  };
  const CaptureFormat format{.shape = {43, 21, 3}};
  Random random(5);
  const Timeline timeline = random_timeline(random, 150);
  const Rasters rasters = random_rasters(random, format, 150);
  FunctionSet functions;
  for (std::uint8_t tag = 0; tag < 3; ++tag) functions.emplace(tag, random_function(random, timeline));
  Mask mask = Mask::uniform(43, 21, 0);
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    mask.tags[pixel] = static_cast<std::uint8_t>(pixel % 43 < 20 ? 0 : random.whole(0, 2));
  }
  Picture first_codes, first_light;
  int combinations = 0;
  for (const Shape& shape : {Shape{64, 16, 8}, {1, 1, 1}, {16, 3, 4}, {64, 1, 16}}) {
    for (const auto& [group_items, chunk_bytes, last_first] : {std::tuple{1u, std::uint64_t{0}, false},
                                                               {7u, std::uint64_t{1}, false},
                                                               {64u, std::uint64_t{0}, true}}) {
      OpenClOptions options = renderer_options(Precision::fixed);
      options.item_pixels = shape.item_pixels;
      options.item_tiles = shape.item_tiles;
      options.lanes = shape.lanes;
      options.group_items = group_items;
      options.chunk_bytes = chunk_bytes;
      options.last_block_first = last_first;
      OpenClRenderer renderer(options);
      for (const auto& [block_samples, policy] : {std::pair{1u, TilePolicy::dense},
                                                  {17u, TilePolicy::rows},
                                                  {64u, TilePolicy::automatic},
                                                  {300u, TilePolicy::records}}) {
        MemoryCapture capture(format, timeline, rasters, block_samples, policy);
        const RenderPlan plan = make_plan(capture, functions, mask, {});
        const Picture codes = renderer.render(plan, capture, {ValueType::code8, 255}).picture;
        const Picture light = renderer.render(plan, capture, {ValueType::light64, 0}).picture;
        if (combinations++ == 0) {
          first_codes = codes;
          first_light = light;
        }
        const std::string what = nutik::format(
            "{} pixels of {} tiles in {} lanes, groups of {}, chunks of {}, blocks of {}{}, tiles {}",
            shape.item_pixels, shape.item_tiles, shape.lanes, group_items, chunk_bytes, block_samples,
            last_first ? " from the last" : "", to_text(policy));
        ASSERT_TRUE(codes.bytes == first_codes.bytes) << what;
        ASSERT_TRUE(light.bytes == first_light.bytes) << what;
      }
    }
  }
  std::printf("%d combinations, the same bytes\n", combinations);
}

}  // namespace
}  // namespace nutik::test
