// The reference against exact rational arithmetic.
#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "render/reference_renderer.hpp"
#include "support/bounds.hpp"
#include "support/exact_exposure.hpp"
#include "support/payloads.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

TEST(Reference, StaysWithinAFewUlpOfExactArithmetic) {
  double worst = 0.0;
  const Seeds seeds = test::seeds(0, 60);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    RandomCase random(seed);
    random.capture.noise.tolerance = 0;  // held codes are the source's
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const Picture picture = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
    worst = std::max(worst, worst_roundings(plan, random, picture, seed, kReferenceRoundings));
  }
  std::printf("worst error of the reference: %.2f u of ∫|g|/D\n", worst);
}

// By hand: 8 samples at 100 a second, shutter 180 degrees, codes 10 k of 255, linear.
class ByHand : public testing::Test {
 protected:
  static double light(const GainFunction& function) {
    Rasters rasters;
    for (int k = 0; k < 8; ++k) rasters.push_back({static_cast<std::byte>(10 * k)});
    MemoryCapture source({.shape = {1, 1, 1}, .transfer = Transfer::linear()},
                         Timeline::constant({100, 1}, {180, 1}, 8), rasters, 3);
    const RenderPlan plan = make_plan(source, {{0, function}}, Mask::uniform(1, 1, 0), {});
    return ReferenceRenderer().render(plan, source, {ValueType::light64, 0}).picture.values<double>()[0] *
           255.0;
  }
};

TEST_F(ByHand, ABoxcarOverOneSampleGivesItsCode) {
  EXPECT_NEAR(light(GainFunction::boxcar(30'000'000, 35'000'000)), 30.0, 1e-13);
  EXPECT_NEAR(light(GainFunction::boxcar(32'000'000, 32'001'000)), 30.0, 1e-13);  // 1 µs inside it
}

TEST_F(ByHand, ABoxcarInAGapGivesTheLinesMean) {
  EXPECT_NEAR(light(GainFunction::boxcar(35'000'000, 40'000'000)), 35.0, 1e-13);
  EXPECT_NEAR(light(GainFunction::boxcar(36'000'000, 37'000'000)), 33.0, 1e-13);  // 30 + 10 · 1.5/5
}

TEST_F(ByHand, ABoxcarOverAPeriodGivesExposureAndRamp) {
  EXPECT_NEAR(light(GainFunction::boxcar(30'000'000, 40'000'000)), 32.5, 1e-13);
}

TEST_F(ByHand, TheLastSampleHoldsToTheEnd) {
  EXPECT_NEAR(light(GainFunction::boxcar(75'000'000, 80'000'000)), 70.0, 1e-13);
}

TEST_F(ByHand, ARampOfGainAcrossARampOfLight) {
  // g from 0 to 1 and v from 30 to 40 over the gap: ∫ = 5 ms (0·30/3 + (0·40 + 1·30)/6 + 1·40/3).
  const GainFunction ramp({{35'000'000, 0.0}, {40'000'000, 1.0}, {40'000'000, 0.0}});
  EXPECT_NEAR(light(ramp), 30.0 / 6 + 40.0 / 3, 1e-13);
}

TEST_F(ByHand, NegativeGainsSubtract) {
  const GainFunction difference({{10'000'000, 0.0},
                                 {10'000'000, -1.0},
                                 {15'000'000, -1.0},
                                 {15'000'000, 0.0},
                                 {60'000'000, 0.0},
                                 {60'000'000, 1.0},
                                 {65'000'000, 1.0},
                                 {65'000'000, 0.0}});
  EXPECT_NEAR(light(difference), (60.0 - 10.0) / 2, 1e-13);
}

// A capture whose payloads are changed while they are read, as a crafted file's may be.
class CraftedCapture final : public CaptureSource {
 public:
  CraftedCapture(MemoryCapture& capture, std::uint64_t at, std::byte value)
      : capture_(capture), at_(at), value_(value) {}
  [[nodiscard]] const CaptureFormat& format() const override { return capture_.format(); }
  [[nodiscard]] const Timeline& timeline() const override { return capture_.timeline(); }
  [[nodiscard]] std::uint64_t block_count() const override { return capture_.block_count(); }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t b) const override { return capture_.block_extent(b); }

 private:
  BlockLease lend(std::uint64_t block, const LeaseTerms& /*terms*/) override {
    const auto payload = std::make_shared<std::vector<std::byte>>(payload_of(capture_, block));
    (*payload)[at_] = value_;
    return {capture_.block_extent(block), *payload, payload};
  }

  MemoryCapture& capture_;
  std::uint64_t at_;
  std::byte value_;
};

TEST(Reference, RefusesSampleNumbersThatNoTileCanHave) {
  Rasters rasters;
  for (const int code : {0, 0, 5, 5, 9, 9}) rasters.emplace_back(64, static_cast<std::byte>(code));
  const Timeline timeline = Timeline::constant({100, 1}, {180, 1}, 6);
  // Behind the directory of 64 bytes: three rows at samples 0, 2, 4; or a start of 64 codes and a slot at
  // sample 2 for each pixel.
  struct Case {
    TilePolicy policy;
    std::uint64_t first_index;
    int value;
  };
  for (const Case& each :
       {Case{TilePolicy::rows, 64, 2}, Case{TilePolicy::rows, 64, 255}, Case{TilePolicy::rows, 65, 0},
        Case{TilePolicy::rows, 65, 4}, Case{TilePolicy::records, 128, 0}, Case{TilePolicy::records, 128, 5},
        Case{TilePolicy::records, 128, 255}}) {
    MemoryCapture capture({.shape = {8, 8, 1}}, timeline, rasters, 6, each.policy);
    const GainFunction gain = GainFunction::boxcar(0, 60'000'000);
    const RenderPlan plan = make_plan(capture, {{0, gain}}, Mask::uniform(8, 8, 0), {});
    EXPECT_NO_THROW(static_cast<void>(ReferenceRenderer().render(plan, capture, {ValueType::light64, 0})));
    CraftedCapture crafted(capture, each.first_index, static_cast<std::byte>(each.value));
    EXPECT_THROW(static_cast<void>(ReferenceRenderer().render(plan, crafted, {ValueType::light64, 0})), InputError)
        << to_text(each.policy) << ", byte " << each.first_index << " = " << each.value;
  }
}

}  // namespace
}  // namespace nutik::test
