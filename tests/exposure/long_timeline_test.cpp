// Tables of captures that last a day: 86 million samples, of which no pixel and no whole table is ever held.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exposure/weight_integrator.hpp"
#include "support/bounds.hpp"
#include "support/exact.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

constexpr std::int64_t kDayNs = 86'400'000'000'000;

struct Rate {
  const char* name;
  Rational rate;
  Rational shutter_angle;
  std::uint64_t samples;  // in 24 h
};

class ADay : public testing::TestWithParam<Rate> {
 protected:
  Timeline timeline_ = Timeline::constant(GetParam().rate, GetParam().shutter_angle, GetParam().samples);
};

// Gains over the whole day: slow ramps, and what ends hours in one nanosecond.
GainFunction all_day(const Timeline& timeline) {
  const std::uint64_t middle = timeline.sample_count() / 2;
  return GainFunction({{-3, 0.0},
                       {7, 1.0},
                       {kDayNs / 5, -2.5},
                       {kDayNs / 5 + 1, 3.0},
                       {timeline.start_ns(middle) - 1, 1e-3},
                       {timeline.start_ns(middle), -1.0},
                       {timeline.end_ns(middle), 1.0},
                       {timeline.end_ns(middle) + 1, 0.25},
                       {timeline.duration_ns() - 1, 1.5},
                       {timeline.duration_ns() + 1, 0.0}});
}

// 10,000 entries, in slices of the table that are packed one by one, in any order: the first, the last, round
// every control point, and wherever else.
TEST_P(ADay, HasTheTablesThatExactArithmeticSays) {
  constexpr std::uint64_t kEntries = 10'000, kBlock = 64;
  const GainFunction function = all_day(timeline_);
  const GainSummary summary = summarize(function, timeline_.duration_ns());
  const auto gain = exact_gain(function, timeline_.duration_ns());
  const auto magnitudes = magnitude_of(gain);
  ASSERT_EQ(summary.support_ns, exact_summary(gain).support_ns);
  const Exact unit = Exact(std::scalbn(1.0, summary.exponent)) * summary.support_ns;

  const std::uint64_t count = timeline_.sample_count();
  std::vector<std::uint64_t> firsts{0, count - kBlock};
  for (const ControlPoint& point : function.points()) {
    const std::int64_t time_ns = std::clamp<std::int64_t>(point.time_ns, 0, timeline_.duration_ns() - 1);
    const std::uint64_t k = timeline_.samples_reaching(time_ns, time_ns + 1).first;
    firsts.push_back(std::clamp<std::uint64_t>(k, kBlock / 2, count - kBlock / 2) - kBlock / 2);
  }
  Random random(24);
  while (firsts.size() * kBlock < kEntries) {
    firsts.push_back(static_cast<std::uint64_t>(random.whole(0, static_cast<std::int64_t>(count - kBlock))));
  }

  WeightIntegrator integrator(function, summary, timeline_.duration_ns());
  std::vector<double> weights(kBlock), boundaries(kBlock + 1);
  double worst = 0.0;
  for (const std::uint64_t first : firsts) {
    integrator.pack(timeline_.times({first, first + kBlock}), weights, boundaries);
    Exact boundary = 0, boundary_scale = 0;
    for (std::uint64_t i = 0; i < kBlock; ++i) {
      const Exact weight = exact_weight_ns(gain, timeline_, first + i) / unit;
      const Exact scale = exact_weight_ns(magnitudes, timeline_, first + i) / unit;
      const double units = error_in(scale, weights[i], weight) / kRoundoff64;
      ASSERT_LE(units, kWeightRoundings) << "weight of sample " << first + i << "; rerun: " << rerun();
      worst = std::max(worst, units);
      boundary += weight;
      boundary_scale += scale;
      ASSERT_LE(error_in(boundary_scale, boundaries[i + 1], boundary) / kRoundoff64, kWeightRoundings + 1)
          << "boundary behind sample " << first + i << "; rerun: " << rerun();
    }
  }
  std::printf("%zu weights of %llu: worst error %.2f u of its own ∫ĝφ\n", firsts.size() * kBlock,
              static_cast<unsigned long long>(count), worst);
}

// Times of a day's last samples do not drift: each is the exact one, rounded.
TEST_P(ADay, RoundsEveryTimeFromItsOwnExactValue) {
  Random random(25);
  const Exact rate = Exact(GetParam().rate.numerator) / GetParam().rate.denominator;
  const Exact open = Exact(GetParam().shutter_angle.numerator) / GetParam().shutter_angle.denominator / 360;
  const auto rounds_to = [](std::int64_t time_ns, const Exact& exact) {
    return Exact(time_ns) - Exact(1, 2) <= exact && exact < Exact(time_ns) + Exact(1, 2);
  };
  for (int i = 0; i < 10'000; ++i) {
    const auto k =
        static_cast<std::uint64_t>(random.whole(0, static_cast<std::int64_t>(timeline_.sample_count()) - 1));
    ASSERT_TRUE(rounds_to(timeline_.start_ns(k), Exact(k) * 1'000'000'000 / rate)) << "sample " << k;
    ASSERT_TRUE(rounds_to(timeline_.end_ns(k), (Exact(k) + open) * 1'000'000'000 / rate)) << "sample " << k;
  }
  ASSERT_TRUE(rounds_to(timeline_.duration_ns(), Exact(timeline_.sample_count()) * 1'000'000'000 / rate));
}

INSTANTIATE_TEST_SUITE_P(, ADay,
                         testing::Values(Rate{"At1000", {1000, 1}, {360, 1}, 86'400'000},
                                         Rate{"At1000WithGaps", {1000, 1}, {1728, 10}, 86'400'000},
                                         Rate{"At30000Over1001", {30000, 1001}, {180, 1}, 2'589'410},
                                         Rate{"At960", {960, 1}, {90, 1}, 82'944'000}),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace nutik::test
