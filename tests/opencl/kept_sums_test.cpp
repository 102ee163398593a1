// Steady gains: exposures are within their bound, and the same to the last bit whether sums of blocks and bundles were
// kept or are made.
#include <gtest/gtest.h>

#include "capture/format.hpp"
#include "render/picture_errors.hpp"
#include "render/plan_cache.hpp"
#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

// A boxcar, or steps of several gains: from and to edges of blocks and samples, a nanosecond beside them, or anywhere.
GainFunction random_steps(Random& random, const MemoryCapture& capture) {
  const Timeline& timeline = capture.timeline();
  const auto random_time = [&] {
    const auto block =
        static_cast<std::uint64_t>(random.whole(0, static_cast<std::int64_t>(capture.block_count()) - 1));
    const SampleRange samples = capture.block_extent(block).range();
    std::int64_t time_ns = 0;
    switch (random.whole(0, 3)) {
      case 0: time_ns = timeline.reach_begin_ns(samples.first); break;
      case 1: time_ns = timeline.end_ns(samples.last - 1); break;
      case 2: time_ns = timeline.start_ns(samples.first) + random.whole(-1, 1); break;
      default: return random.whole(0, timeline.duration_ns());
    }
    return std::clamp<std::int64_t>(time_ns, 0, timeline.duration_ns());
  };
  std::vector<std::int64_t> times(static_cast<std::size_t>(random.whole(1, 3)));
  for (std::int64_t& time : times) time = random_time();
  std::ranges::sort(times);
  times.erase(std::ranges::unique(times).begin(), times.end());
  double gain = random.chance(0.5) ? 0.0 : random.real(-2, 2);
  std::vector<ControlPoint> points;
  for (const std::int64_t time : times) {
    points.push_back({time, gain});
    gain = random.chance(0.2) ? 0.0 : random.real(-2, 2);
    points.push_back({time, gain});
  }
  if (random.chance(0.2)) points.push_back({times.back() + timeline.duration_ns() / 3, random.real(-1, 1)});
  return GainFunction(std::move(points));
}

struct SteadyCase {
  std::optional<MemoryCapture> capture;
  FunctionSet functions;
  Mask mask;

  explicit SteadyCase(std::uint64_t seed) {
    Random random(seed);
    CaptureFormat format = random_format(random);
    // Few kernels, and tiles enough for regions.
    format.shape = {static_cast<std::uint32_t>(random.whole(9, 40)), 17, 1};
    format.code_bytes = 1;
    format.white_code = 255;
    format.transfer = random.chance(0.5) ? Transfer::srgb() : Transfer::linear();
    if (random.chance(0.2)) {
      format.noise = {};
      format.noise.camera = CameraNoise{
          255, format.transfer, {{NoiseCurve::sensor, random.real(1e-3, 0.02), random.real(1e-4, 1e-2), {}}}};
    }
    const bool is_long =
        random.chance(0.25);  // with blocks that are long enough for halves, most of them exposed
    const auto samples =
        static_cast<std::uint64_t>(is_long ? random.whole(720, 900) : random.whole(150, 900));
    const auto block_samples =
        static_cast<std::uint32_t>(is_long ? random.whole(32, 36) : random.whole(16, 24));
    capture.emplace(format, random_timeline(random, samples), random_rasters(random, format, samples), block_samples,
                    random.chance(0.3) ? TilePolicy::dense : TilePolicy::automatic);
    for (std::uint8_t tag = 0; tag < 3; ++tag) functions.emplace(tag, random_steps(random, *capture));
    if (is_long) {
      const std::int64_t end_ns = capture->timeline().duration_ns();
      functions.at(0) = GainFunction::boxcar(random.whole(0, end_ns / 10),
                                             random.whole(end_ns * 9 / 10, end_ns), random.real(-2, 2));
    }
    mask = Mask::uniform(format.shape.width, format.shape.height, 0);
    const std::int64_t kind = random.whole(0, 2);  // one function; whole tiles of each; pixels
    for (std::size_t pixel = 0; pixel < mask.tags.size() && kind > 0; ++pixel) {
      const std::size_t x = pixel % format.shape.width;
      mask.tags[pixel] = static_cast<std::uint8_t>(kind == 1 ? x / kTileSide % 3 : x % 3);
    }
  }

  [[nodiscard]] RenderPlan plan() const { return make_plan(*capture, functions, mask, {}); }
};

bool has_halves(const RenderPlan& plan) {
  return std::ranges::any_of(plan.blocks, [&](const PlannedBlock& planned) {
    return std::ranges::any_of(plan.functions, [&](const PlannedFunction& function) {
      return function.table->steady_in(planned.block).bundle.halves != Halves::both;
    });
  });
}

class KeptSumsOf : public OfPrecision {
 protected:
  // What it takes to render a boxcar that begins at one time after another, over blocks of so many samples of 1 ms.
  std::vector<RenderStatistics> statistics_of_moved_boxcar(std::uint64_t blocks, std::uint32_t block_samples,
                                                           std::initializer_list<std::int64_t> starts_ms,
                                                           std::int64_t length_ms) {
    const CaptureFormat format{.shape = {24, 16, 1}};
    const std::uint64_t samples = blocks * block_samples;
    Random random(3);
    MemoryCapture capture(format, Timeline::constant({1000, 1}, {180, 1}, samples),
                          random_rasters(random, format, samples), block_samples);
    OpenClOptions options = renderer_options(GetParam());
    options.allocation_bytes = 0;  // that all sums have room
    OpenClRenderer renderer(options);
    renderer.keep_resident(&capture);
    PlanCache plans;
    std::vector<RenderStatistics> all;
    for (const std::int64_t start_ms : starts_ms) {
      const GainFunction boxcar = GainFunction::boxcar(start_ms * 1'000'000, (start_ms + length_ms) * 1'000'000);
      const RenderPlan plan = plans.plan(capture, {{0, boxcar}}, Mask::uniform(24, 16, 0), {});
      const Rendered rendered = renderer.render(plan, capture, kLight);
      EXPECT_EQ(rendered.picture.bytes, fresh_.render(plan, capture, kLight).picture.bytes);
      all.push_back(rendered.statistics);
    }
    renderer.keep_resident(nullptr);
    return all;
  }

  OpenClRenderer fresh_{options()};
  OpenClRenderer renderer_{options()};
};

// NUTIK_TEST_CASES=10000 is the full run.
TEST_P(KeptSumsOf, RandomCasesAreWithinTheBoundAndTheSameBits) {
  const Seeds seeds = test::seeds(0, 60);
  std::uint64_t kept = 0, bundles = 0, corrected = 0, halves = 0, noisy = 0;
  double worst = 0.0;
  ReferenceRenderer reference;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SteadyCase random(seed);
    const RenderPlan plan = random.plan();
    bundles += plan.has_bundles();
    corrected += plan.has_corrected();
    halves += has_halves(plan);
    noisy += random.capture->format().noise.camera.has_value();
    const Picture expected = reference.render(plan, *random.capture, kLight).picture;
    const Picture made = fresh_.render(plan, *random.capture, kLight).picture;
    const LightErrors errors = light_errors(plan, error_bound(plan, GetParam(), kLight), expected, made);
    ASSERT_LE(errors.share_of_bound, 1.0) << rerun(seed);
    worst = std::max(worst, errors.share_of_bound);
    renderer_.keep_resident(&*random.capture);
    for (int time = 0; time < 3; ++time) {
      // Another plan of the same functions: all are exposed again.
      const Rendered again = renderer_.render(random.plan(), *random.capture, kLight);
      ASSERT_TRUE(again.picture.bytes == made.bytes) << rerun(seed);
      kept += again.statistics.kept_sums;
      if (time == 0) {
        ASSERT_EQ(again.statistics.kept_sums, 0u);
      }
      if (time == 2) {
        ASSERT_EQ(again.statistics.made_sums, 0u) << rerun(seed);
      }
    }
    // What another function wants of the same sums.
    random.functions.at(0) = GainFunction({{0, 0.7}});
    const RenderPlan other = random.plan();
    ASSERT_EQ(renderer_.render(other, *random.capture, kLight).picture.bytes,
              fresh_.render(other, *random.capture, kLight).picture.bytes)
        << rerun(seed);
  }
  renderer_.keep_resident(nullptr);
  std::printf(
      "%s: %llu sums kept, %llu cases with bundles, %llu with corrections, %llu with halves, %llu of known "
      "noise, worst error %.2f of its bound\n",
      to_text(GetParam()).c_str(), static_cast<unsigned long long>(kept),
      static_cast<unsigned long long>(bundles), static_cast<unsigned long long>(corrected),
      static_cast<unsigned long long>(halves), static_cast<unsigned long long>(noisy), worst);
  if (seeds.last - seeds.first >= 60) {
    EXPECT_EQ(kept > 0, GetParam() != Precision::fixed);
    EXPECT_GT(bundles, 0u);
    EXPECT_GT(corrected, 0u);
    EXPECT_GT(halves, 0u);
    EXPECT_GT(noisy, 0u);
  }
}

// A long boxcar that is moved reads the blocks at its ends alone, once sums are kept.
TEST_P(KeptSumsOf, AMovedBoxcarReadsItsEnds) {
  const auto all = statistics_of_moved_boxcar(100, 16, {100, 101, 102, 118}, 1234);
  if (GetParam() == Precision::fixed) {
    for (const RenderStatistics& each : all) EXPECT_EQ(each.kept_sums + each.made_sums, 0u);
    return;
  }
  EXPECT_EQ(all[0].made_sums, 0u);
  EXPECT_GT(all[0].blocks, 70u);
  EXPECT_GT(all[1].made_sums, 8u);
  EXPECT_EQ(all[2].made_sums, 0u);
  EXPECT_EQ(all[2].blocks, 2u);  // the ends
  EXPECT_LE(all[3].blocks, 2u + 1u);
}

// Blocks of 32 samples, cut near their middles: what is read are few samples beside it.
TEST_P(KeptSumsOf, HalvesOfCutBlocksAreKept) {
  if (GetParam() == Precision::fixed) GTEST_SKIP() << "knows nothing of steady gains";
  // It begins in block 3, and ends in block 42.
  const auto all = statistics_of_moved_boxcar(50, 32, {110, 111, 112, 114}, 1250);
  EXPECT_EQ(all[0].made_sums, 0u);
  for (const std::size_t later : {2u, 3u}) {
    EXPECT_EQ(all[later].made_sums, 0u);
    EXPECT_EQ(all[later].kept_sums, 2u + 3u) << "halves, and bundles between them";
    EXPECT_EQ(all[later].blocks, 2u) << "samples beside the halves";
  }
}

// Among several functions only those that changed are exposed again, and pictures are those of all.
TEST_P(KeptSumsOf, AChangedFunctionAloneIsExposed) {
  SteadyCase random(5);
  MemoryCapture& capture = *random.capture;
  const Shape& shape = capture.format().shape;
  for (std::size_t pixel = 0; pixel < random.mask.tags.size(); ++pixel) {
    random.mask.tags[pixel] = static_cast<std::uint8_t>(pixel % shape.width / kTileSide % 3);
  }
  renderer_.keep_resident(&capture);
  PlanCache plans;
  const std::int64_t end_ns = capture.timeline().duration_ns();
  const auto render = [&] {
    const RenderPlan plan = plans.plan(capture, random.functions, random.mask, {});
    const Rendered rendered = renderer_.render(plan, capture, kLight);
    EXPECT_TRUE(rendered.picture.bytes == fresh_.render(plan, capture, kLight).picture.bytes);
    return rendered.statistics;
  };
  for (std::uint8_t tag = 0; tag < 3; ++tag) {
    random.functions.at(tag) = GainFunction({{0, 0.1}, {end_ns / 2 + tag, 1.0}, {end_ns, 0.3}});
  }
  EXPECT_EQ(render().exposed_functions, 3u);
  const RenderStatistics again = render();
  EXPECT_EQ(again.exposed_functions, 0u);
  EXPECT_EQ(again.launches, 0u);
  random.functions.at(1) = GainFunction({{0, 0.1}, {end_ns / 3, 1.0}, {end_ns, 0.3}});
  EXPECT_EQ(render().exposed_functions, 1u);
  random.functions.at(0) = GainFunction::boxcar(2, 3);  // some of the first block alone
  const RenderStatistics brief = render();
  if (GetParam() != Precision::fixed) {
    EXPECT_EQ(brief.blocks, 1u);
  }
  random.functions.at(0) = GainFunction({{0, 0.0}});  // nothing
  static_cast<void>(render());
  random.mask.tags[0] = 2;  // a tile of two functions
  EXPECT_EQ(render().exposed_functions, 3u);
  random.functions.at(2) = GainFunction({{0, 0.3}, {end_ns, 0.1}});
  static_cast<void>(render());
  renderer_.keep_resident(nullptr);
}

// Nothing, times less than nothing, is 0 and not -0, wherever a pixel's sums begin.
TEST_P(KeptSumsOf, BlackIsZeroWhateverIsExposedFirst) {
  const CaptureFormat format{.shape = {16, 8, 1}};
  const Rasters black(48, std::vector<std::byte>(format.sample_bytes()));
  MemoryCapture capture(format, Timeline::constant({1000, 1}, {360, 1}, 48), black, 16);
  Mask mask = Mask::uniform(16, 8, 0);
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) mask.tags[pixel] = pixel % 16 >= 8;
  renderer_.keep_resident(&capture);
  PlanCache plans;
  for (const double gain : {-1.0, -2.0}) {
    // The first function needs no block but the second, the other one, which stays, all three.
    const FunctionSet functions{{0, GainFunction::boxcar(16'000'000, 32'000'000, gain)},
                                {1, GainFunction({{0, 0.5}})}};
    const RenderPlan plan = plans.plan(capture, functions, mask, {});
    EXPECT_TRUE(renderer_.render(plan, capture, kLight).picture.bytes ==
                fresh_.render(plan, capture, kLight).picture.bytes)
        << gain;
  }
  renderer_.keep_resident(nullptr);
}

// A budget that holds few sums, and one that holds none, change no bit.
TEST_P(KeptSumsOf, AnyMemoryHasTheSamePictures) {
  const SteadyCase random(11);
  MemoryCapture& capture = const_cast<MemoryCapture&>(*random.capture);
  const RenderPlan plan = make_plan(capture, {{0, GainFunction({{0, 0.5}})}},
                                    Mask::uniform(random.mask.width, random.mask.height, 0), {});
  const std::vector<std::byte> expected = fresh_.render(plan, capture, kLight).picture.bytes;
  for (const std::uint64_t bytes : {std::uint64_t{1} << 17, std::uint64_t{1} << 18, std::uint64_t{1} << 30}) {
    OpenClOptions options = renderer_options(GetParam());
    options.memory_bytes = bytes;
    options.chunk_bytes = 4096;
    OpenClRenderer renderer(options);
    renderer.keep_resident(&capture);
    for (int time = 0; time < 3; ++time) {
      ASSERT_EQ(renderer.render(plan, capture, kLight).picture.bytes, expected) << bytes;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, KeptSumsOf, testing::ValuesIn(kPrecisions),
                         [](const auto& test) { return to_text(test.param); });

}  // namespace
}  // namespace nutik::test
