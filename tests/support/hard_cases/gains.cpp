// Hard cases of gain: sums that cancel, and numbers far apart, very many, very large or very small.
#include <limits>

#include "support/hard_cases/parts.hpp"

namespace nutik::test {
namespace {

// Falls from 1 to -1 within each sample, at its middle, early, late or with jumps.
HardCase sign_changes_within_samples() {
  const Timeline timeline = Timeline::constant({60, 1}, kHalfShutter, 20);
  std::vector<std::vector<ControlPoint>> points(3);
  for (std::uint64_t k = 0; k < timeline.sample_count(); ++k) {
    const std::int64_t begin_ns = timeline.start_ns(k);
    const std::int64_t end_ns = timeline.end_ns(k);
    const std::int64_t middle_ns = (begin_ns + end_ns) / 2;
    for (const ControlPoint& point :
         {ControlPoint{begin_ns, 0.0}, {begin_ns, 1.0}, {end_ns, -1.0}, {end_ns, 0.0}}) {
      points[0].push_back(point);
    }
    for (const ControlPoint& point : {ControlPoint{begin_ns + 1, 0.0},
                                      {begin_ns + 2, 1.0},
                                      {middle_ns, 1.0},
                                      {middle_ns + 1, -1.0},
                                      {end_ns - 2, -1.0},
                                      {end_ns - 1, 0.0}}) {
      points[1].push_back(point);
    }
    for (const ControlPoint& point :
         {ControlPoint{begin_ns, -1e-3}, {begin_ns + 1000, 1.0}, {end_ns, -2e-3}}) {
      points[2].push_back(point);
    }
  }
  std::vector<GainFunction> functions;
  for (auto& each : points) functions.emplace_back(std::move(each));
  return noisy_case(format_of({8, 6, 1}, Transfer::srgb()), timeline, std::move(functions));
}

// + 1 for half a second, - (1 - 2e-9) for the next: ∫g is 1e-9 of ∫|g|. Gains of 1e9 make it a picture again,
// of the scene itself.
HardCase cancels_to_a_billionth_on_a_still_scene() {
  const Timeline timeline = Timeline::constant({100, 1}, Timeline::kFullShutter, 100);
  const auto difference = [](double plus, double minus) {
    return GainFunction({{0, plus}, {kSecondNs / 2, plus}, {kSecondNs / 2, minus}, {kSecondNs, minus}});
  };
  const CaptureFormat capture = format_of({16, 16, 1}, Transfer::srgb());
  return taking_turns(capture, timeline, still(capture),
                      {difference(1.0, -(1.0 - 2e-9)), difference(1e9, -(1e9 - 2.0))});
}

// The difference of two moments, over and over, of a scene of which hardly anything moves.
HardCase cancels_from_sample_to_sample() {
  const Timeline timeline = Timeline::constant({240, 1}, kHalfShutter, 300);
  std::vector<ControlPoint> points;
  for (std::uint64_t k = 0; k < timeline.sample_count(); ++k) {
    const double gain = k % 2 == 0 ? 1000.0 : -1000.0;
    points.push_back({timeline.start_ns(k), gain});
    points.push_back({timeline.end_ns(k), gain});
  }
  const CaptureFormat capture = format_of({9, 8, 1}, Transfer::gamma(2.2));
  const DrawSample scene = still(capture);
  const DrawSample moving = [=](std::uint64_t k) {
    std::vector<std::byte> raster = scene(k);
    set_code(capture, raster, k % capture.shape.value_count(), 255);
    return raster;
  };
  return taking_turns(capture, timeline, moving, {GainFunction(std::move(points))});
}

HardCase a_million_and_a_millionth() {
  const Timeline timeline = Timeline::constant({30, 1}, kHalfShutter, 30);
  std::vector<ControlPoint> alternating, parted;
  const double gains[] = {1e6, -1e-6, -1e6, 1e-6, 1e6, 1e-6, -1e-6, -1e6};
  for (int i = 0; i < 64; ++i) alternating.push_back({i * 15'500'000, gains[i % 8]});
  alternating.push_back({64 * 15'500'000, 0.0});
  for (int i = 0; i < 40; ++i) {
    parted.push_back({i * 24'000'000, (i < 20 ? 1e6 : 1e-6) * (i % 2 == 0 ? 1.0 : -1.0)});
  }
  parted.push_back({40 * 24'000'000, 0.0});
  return noisy_case(format_of({8, 6, 1}, Transfer::linear(), 4095), timeline,
                    {GainFunction(std::move(alternating)), GainFunction(std::move(parted))});
}

HardCase all_regions_with_256_points() {
  const Timeline timeline = Timeline::constant({30000, 1001}, kHalfShutter, 24);
  Random random(256);
  std::vector<GainFunction> functions;
  for (int tag = 0; tag < 256; ++tag) {
    std::vector<ControlPoint> points;
    std::int64_t time_ns = random.whole(-1'000'000, 1'000'000);
    for (int i = 0; i < 256; ++i) {
      points.push_back({time_ns, random.real(-2.0, 3.0)});
      time_ns += random.whole(1, 6'000'000);
    }
    functions.emplace_back(std::move(points));
  }
  return noisy_case(format_of({16, 16, 1}, Transfer::srgb()), timeline, std::move(functions));
}

HardCase a_function_of_100000_points() {
  const Timeline timeline = Timeline::constant({960, 1}, kHalfShutter, 60);
  Random random(100'000);
  std::vector<ControlPoint> points;
  std::int64_t time_ns = 0;
  for (int i = 0; i < 100'000; ++i) {
    points.push_back({time_ns, random.real(-1.0, 1.5)});
    time_ns += random.whole(1, 1249);
  }
  return noisy_case(format_of({3, 3, 1}, Transfer::srgb()), timeline, {GainFunction(std::move(points))});
}

HardCase subnormal_gains() {
  const Timeline timeline = Timeline::constant({25, 1}, kHalfShutter, 8);
  const std::int64_t end_ns = timeline.duration_ns();
  constexpr double kMin = std::numeric_limits<double>::denorm_min();
  return noisy_case(
      format_of({8, 5, 1}, Transfer::srgb()), timeline,
      {GainFunction::boxcar(0, end_ns, kMin), GainFunction({{-end_ns, 3 * kMin}, {2 * end_ns, kMin}}),
       GainFunction({{0, 1e-310}, {end_ns, -2e-312}}),
       GainFunction({{0, 1e-300}, {end_ns / 2, 1e-320}, {end_ns, -1e-301}}), pulse(50'000'000, kMin)});
}

// The largest finite double itself would round to infinity where a pixel is white.
HardCase huge_gains() {
  const Timeline timeline = Timeline::constant({25, 1}, kHalfShutter, 8);
  const std::int64_t end_ns = timeline.duration_ns();
  constexpr double kHuge = std::numeric_limits<double>::max() / 2;
  return noisy_case(
      format_of({8, 5, 1}, Transfer::srgb()), timeline,
      {GainFunction::boxcar(0, end_ns, kHuge), GainFunction({{-end_ns, kHuge}, {2 * end_ns, -kHuge}}),
       GainFunction({{0, 1e300}, {end_ns / 2, 1e-300}, {end_ns, -1e299}}), pulse(50'000'000, -kHuge)});
}

// Beyond what products of two numbers in single precision can hold, though not each of them.
HardCase gains_at_the_limits_of_single_precision() {
  const Timeline timeline = Timeline::constant({25, 1}, kHalfShutter, 8);
  const std::int64_t end_ns = timeline.duration_ns();
  return noisy_case(format_of({8, 5, 1}, Transfer::linear(), 4095), timeline,
                    {GainFunction::boxcar(0, end_ns, 1e37), GainFunction::boxcar(0, end_ns, -1e-37),
                     GainFunction({{0, 3e37}, {end_ns / 2, -1e-37}, {end_ns, -1e37}}),
                     GainFunction({{0, 0.0}, {10, 1e37}, {20, 0.0}, {end_ns - 1, 0.0}, {end_ns, 1e-30}})});
}

constexpr NamedHardCase kGainCases[] = {
    {"SignChangesWithinSamples",
     "weights are 0 or nearly so where |g| is 1: errors are not in proportion to them",
     sign_changes_within_samples},
    {"CancelsToABillionthOnAStillScene", "two large sums differ in the tenth digit",
     cancels_to_a_billionth_on_a_still_scene},
    {"CancelsFromSampleToSample", "every sample takes away what the one before gave",
     cancels_from_sample_to_sample},
    {"AMillionAndAMillionth", "gains of one function differ by 10^12, in both signs",
     a_million_and_a_millionth},
    {"AllRegionsWith256Points", "256 functions of 256 points at once, every pixel another",
     all_regions_with_256_points},
    {"AFunctionOf100000Points", "1700 control points a sample, some 1 ns apart", a_function_of_100000_points},
    {"SubnormalGains", "digits are lost unless gains are scaled first", subnormal_gains},
    {"HugeGains", "products overflow unless gains are scaled first", huge_gains},
    {"GainsAtTheLimitsOfSinglePrecision", "gains that a float holds, scales that it may not",
     gains_at_the_limits_of_single_precision},
};

}  // namespace

std::span<const NamedHardCase> hard_gains() { return kGainCases; }

}  // namespace nutik::test
