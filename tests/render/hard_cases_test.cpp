// The reference and the packed tables against exact rational arithmetic, on hard cases.
#include "support/hard_cases.hpp"
#include "support/packed_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/reference_renderer.hpp"
#include "support/bounds.hpp"
#include "support/exact_exposure.hpp"
#include "support/random_case.hpp"
#include "support/right_codes.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

// What a rounding costs, where numbers are of this scale. Doubles end at 2^-1074: beside gains that small a
// rounding is half of that, whatever it is of; beside all others that is nothing.
Exact rounding(const Exact& scale, const Exact& least) {
  return scale == 0 ? Exact(0) : Exact(Exact(kRoundoff64) * scale + least / 2);
}
const Exact kMinDouble(std::numeric_limits<double>::denorm_min());

// A code is light put through the inverse of the transfer function, which costs a few roundings on the codes' own
// scale. On that of light it is 2.3 times as much at most: no transfer function here is steeper.
constexpr double kInverseRoundings = 16 * kRoundoff64;

class ReferenceOnHardCases : public testing::TestWithParam<NamedHardCase> {};

TEST_P(ReferenceOnHardCases, StaysWithinAFewUlpOfExactArithmetic) {
  const HardCase hard = GetParam().make();
  const auto render = [&](OutputFormat output) {
    StreamingCapture capture = hard.open();
    const RenderPlan plan = make_plan(capture, hard.functions, hard.mask, {});
    return ReferenceRenderer().render(plan, capture, output).picture;
  };
  const StreamingCapture capture = hard.open();
  const RenderPlan plan = make_plan(capture, hard.functions, hard.mask, {});
  const ExactExposure exact(plan, hard.timeline, hard.sample);
  const Picture light = render({ValueType::light64, 0});
  const Picture codes8 = render({ValueType::code8, 255});
  const Picture codes16 = render({ValueType::code16, 65'535});
  const RightCodes right8(hard.capture.transfer, 255);
  const RightCodes right16(hard.capture.transfer, 65'535);
  double worst = 0.0;
  for (const std::uint64_t value : values_to_compare(plan, 256, 1)) {
    const std::size_t f = plan.function_of(value / plan.capture.shape.channels);
    ASSERT_EQ(plan.functions[f].summary.support_ns, exact.summary(f).support_ns) << "D of M" << f;
    const Exact scale = exact.scale(value);
    const Exact exact_light = exact.light(value);
    const double rendered = light.values<double>()[value];
    const double roundings = error_in(rounding(scale, kMinDouble), rendered, exact_light);
    EXPECT_LE(roundings, kReferenceRoundings) << "value " << value << " of M" << f << ": " << rendered << ", exactly "
                                              << exact_light.convert_to<double>() << "; rerun: " << rerun();
    worst = std::max(worst, roundings);

    const double near_light = exact_light.convert_to<double>();
    const double error = kReferenceRoundings * kRoundoff64 * scale.convert_to<double>() + kInverseRoundings;
    EXPECT_TRUE(right8.can_be(codes8.values<std::uint8_t>()[value], near_light, error))
        << "value " << value << " of M" << f << ": code " << +codes8.values<std::uint8_t>()[value] << " for light "
        << near_light << "; rerun: " << rerun();
    EXPECT_TRUE(right16.can_be(codes16.values<std::uint16_t>()[value], near_light, error))
        << "value " << value << " of M" << f << ": code " << codes16.values<std::uint16_t>()[value]
        << " of 65535 for light " << near_light << "; rerun: " << rerun();
  }
  std::printf("%s (%s): worst error of the reference %.2f u of ∫|g|/D\n", GetParam().name, GetParam().reason,
              worst);
}

TEST_P(ReferenceOnHardCases, PacksWeightsThatExactArithmeticConfirms) {
  const HardCase hard = GetParam().make();
  const StreamingCapture capture = hard.open();
  const RenderPlan plan = make_plan(capture, hard.functions, hard.mask, {});
  const auto tables = packed_tables(plan);
  double worst = 0.0;
  for (std::size_t f = 0; f < plan.function_count(); ++f) {
    const GainSummary& summary = plan.functions[f].summary;
    if (summary.support_ns == 0) continue;
    const auto gain = exact_gain(plan.functions[f].function, plan.duration_ns);
    const auto magnitudes = magnitude_of(gain);
    // What a gain of the tables stands for, and D: entries are divided by both.
    const Exact unit = Exact(std::scalbn(1.0, summary.exponent)) * summary.support_ns;
    const Exact least = Exact(kMinDouble) / Exact(std::scalbn(1.0, summary.exponent));
    for (const PlannedBlock& block : plan.blocks) {
      Exact boundary = 0, boundary_scale = 0;
      for (std::uint32_t i = 0; i < block.extent.sample_count; ++i) {
        const std::uint64_t k = block.extent.first_sample + i;
        const std::size_t at = (block.table_row + i) * plan.function_count() + f;
        const Exact weight = exact_weight_ns(gain, hard.timeline, k) / unit;
        const Exact scale = exact_weight_ns(magnitudes, hard.timeline, k) / unit;
        const double roundings = error_in(rounding(scale, least), tables.weights[at], weight);
        ASSERT_LE(roundings, kWeightRoundings) << "M" << f << ", weight of sample " << k << "; rerun: " << rerun();
        worst = std::max(worst, roundings);
        boundary += weight;
        boundary_scale += scale;
        ASSERT_LE(error_in(rounding(boundary_scale, least * (i + 1)), tables.boundaries[at + plan.function_count()],
                           boundary),
                  kWeightRoundings + 1)
            << "M" << f << ", boundary behind sample " << k << "; rerun: " << rerun();
      }
    }
  }
  std::printf("%s: worst error of a weight %.2f u of its own ∫ĝφ\n", GetParam().name, worst);
}

INSTANTIATE_TEST_SUITE_P(, ReferenceOnHardCases, testing::ValuesIn(hard_cases().begin(), hard_cases().end()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace nutik::test
