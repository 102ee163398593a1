// The lightest, darkest and middle sample: against all samples, one by one, and by hand.
#include "capture/memory_needs.hpp"
#include "render/combining_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "capture/error.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

constexpr Combine kAll[] = {Combine::lighten, Combine::darken, Combine::median};

FunctionSet without_gains_below_zero(const FunctionSet& functions) {
  FunctionSet positive;
  for (const auto& [tag, function] : functions) {
    std::vector<ControlPoint> points(function.points().begin(), function.points().end());
    for (ControlPoint& point : points) point.gain = std::abs(point.gain);
    positive.emplace(tag, GainFunction(points));
  }
  return positive;
}

// A function's largest gain while a sample is exposed.
double largest_gain(const GainFunction& function, std::int64_t start_ns, std::int64_t end_ns,
                    std::int64_t duration_ns) {
  double largest = 0.0;
  for (const GainPiece& piece : function.pieces(duration_ns)) {
    if (piece.end_ns <= start_ns || piece.begin_ns >= end_ns) continue;
    if (piece.end_ns - piece.begin_ns == 1 && piece.begin_gain != piece.end_gain) continue;  // a jump
    largest =
        std::max({largest, piece.at(std::max(start_ns, piece.begin_ns)), piece.at(std::min(end_ns, piece.end_ns))});
  }
  return largest;
}

// The reference: no blocks, no tiles, all samples of a value in a row.
double combined(const RenderPlan& plan, const RandomCase& random, std::uint64_t value) {
  const std::uint64_t pixel = value / plan.capture.shape.channels;
  std::vector<Share> shares(plan.shares_of(pixel).begin(), plan.shares_of(pixel).end());
  if (shares.empty()) shares.push_back({plan.function_of(pixel), kWholeShare});
  double sum = 0.0;
  for (const Share& share : shares) {
    const PlannedFunction& planned = plan.functions[share.of];
    std::vector<double> lights;
    const SampleRange exposed = exposed_samples(planned, random.timeline);
    for (const bool in_between : {false, true}) {
      if (!lights.empty()) break;
      for (std::uint64_t k = exposed.first; k < exposed.last; ++k) {
        const std::int64_t end_ns = !in_between ? random.timeline.end_ns(k)
                                    : k + 1 == random.timeline.sample_count() ? plan.duration_ns
                                                                              : random.timeline.start_ns(k + 1);
        const double gain = largest_gain(planned.function, random.timeline.start_ns(k), end_ns, plan.duration_ns);
        const double code = code_at(plan.capture, random.rasters[k], value);
        if (gain > 0.0) lights.push_back(gain * plan.capture.transfer.light_of(code / plan.capture.white_code));
      }
    }
    std::ranges::sort(lights);
    if (lights.empty()) continue;
    const std::size_t n = lights.size();
    const double light = plan.combine == Combine::lighten  ? lights.back()
                         : plan.combine == Combine::darken ? lights.front()
                                                           : (lights[(n - 1) / 2] + lights[n / 2]) / 2;
    if (shares.size() == 1) return light;
    sum += share.size * light;
  }
  return sum / kWholeShare;
}

// With as much memory as it says that it takes, where that is more.
Picture within_what_it_needs(const RenderPlan& plan, CaptureSource& capture, RenderControl control) {
  while (true) {
    try {
      return CombiningRenderer().render(plan, capture, kLight, control).picture;
    } catch (const MemoryTooLittle& error) {
      if (error.min_bytes() <= control.memory_bytes) throw;
      control.memory_bytes = error.min_bytes();
    }
  }
}

// Random captures, masks and functions: to the last bit.
TEST(Combining, IsTheReferencesToTheLastBit) {
  const Seeds seeds = test::seeds(0, 40);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    RandomCase random(seed);
    random.capture.noise.tolerance = 0;  // held codes are the source's
    MemoryCapture capture = random.encode();
    const FunctionSet functions = without_gains_below_zero(random.functions);
    for (const Combine how : kAll) {
      const RenderPlan plan = make_plan(capture, functions, random.mask, {.combine = how});
      RenderControl little;
      little.memory_bytes = 1;  // as few rows at a time as there can be
      for (const RenderControl& control : {RenderControl(), little}) {
        const Picture picture = within_what_it_needs(plan, capture, control);
        const auto found = picture.values<double>();
        for (std::size_t i = 0; i < found.size(); ++i) {
          ASSERT_EQ(found[i], combined(plan, random, i))
              << random.text() << ", value " << i << ", " << static_cast<int>(how) << "; rerun: " << rerun(seed);
        }
      }
    }
  }
}

// Eight samples at 100 a second, shutter 180 degrees, of one pixel.
class CombiningByHand : public testing::Test {
 protected:
  static double light(Combine how, const GainFunction& function) {
    Rasters rasters;
    for (const int code : {10, 90, 30, 200, 60, 20, 50, 70})
      rasters.push_back({static_cast<std::byte>(code)});
    MemoryCapture source({.shape = {1, 1, 1}, .transfer = Transfer::linear()},
                         Timeline::constant({100, 1}, {180, 1}, 8), rasters, 3);
    const RenderPlan plan = make_plan(source, {{0, function}}, Mask::uniform(1, 1, 0), {.combine = how});
    return CombiningRenderer().render(plan, source, kLight).picture.values<double>()[0] * 255;
  }
};

TEST_F(CombiningByHand, TakesTheSamplesOfTheInterval) {
  const GainFunction four = GainFunction::boxcar(10'000'000, 50'000'000);  // samples 1 … 4
  EXPECT_DOUBLE_EQ(light(Combine::lighten, four), 200);
  EXPECT_DOUBLE_EQ(light(Combine::darken, four), 30);
  EXPECT_DOUBLE_EQ(light(Combine::median, four), 75);
  EXPECT_DOUBLE_EQ(light(Combine::median, GainFunction::boxcar(10'000'000, 60'000'000)), 60);
  EXPECT_DOUBLE_EQ(light(Combine::lighten, GainFunction::boxcar(10'000'000, 50'000'000, 0.5)), 100);
}

// With jumps as files have them, a step of 1 ns that begins or ends where a sample does.
TEST_F(CombiningByHand, TakesNoSamplesForJumps) {
  const GainFunction two({{0, 1.0}, {10'000'000, 1.0}, {10'000'001, 0.0}, {39'999'999, 0.0}, {40'000'000, 1.0},
                          {50'000'000, 1.0}, {50'000'001, 0.0}});  // samples 0 and 4
  EXPECT_DOUBLE_EQ(light(Combine::lighten, two), 60);
  EXPECT_DOUBLE_EQ(light(Combine::darken, two), 10);
  EXPECT_DOUBLE_EQ(light(Combine::median, two), 35);
}

TEST_F(CombiningByHand, TakesTheSampleBeforeWhereItsShutterWasClosed) {
  for (const Combine how : kAll) {
    EXPECT_DOUBLE_EQ(light(how, GainFunction::boxcar(36'000'000, 38'000'000)), 200);
    EXPECT_DOUBLE_EQ(light(how, GainFunction::boxcar(76'000'000, 78'000'000)), 70);
  }
}

// A comet's tail: the gain falls, and scales light before the lightest is taken.
TEST_F(CombiningByHand, ScalesLightBefore) {
  const GainFunction falling({{0, 1.0}, {80'000'000, 0.0}});
  EXPECT_NEAR(light(Combine::lighten, falling), 200 * (1 - 30.0 / 80), 1e-9);
  EXPECT_NEAR(light(Combine::darken, falling), 20 * (1 - 50.0 / 80), 1e-9);
}

TEST_F(CombiningByHand, RefusesGainsBelowZero) {
  EXPECT_THROW(light(Combine::lighten, GainFunction::boxcar(0, 30'000'000, -1.0)), UsageError);
}

}  // namespace
}  // namespace nutik::test
