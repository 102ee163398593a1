// What the kernels round, from both sides: inputs whose roundings all fall the same way and come close to the error
// bound, so that a bound which promises too little shows and one more rounding in a kernel breaks it; and inputs that
// need no rounding, which must come out exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "capture/format.hpp"
#include "opencl/opencl_api.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/error_bound.hpp"
#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

// Six times a power of two: a weight is then its gain over the number of samples, exactly, if the gain has 51 bits and
// there are a power of two of samples.
constexpr std::int64_t kSampleNs = 6 * 1024;

Timeline timeline_of(std::size_t samples) {
  return Timeline::constant({1'000'000'000, kSampleNs}, Timeline::kFullShutter, samples);
}

// Sample k counts gains[k] times.
GainFunction steps(const std::vector<double>& gains) {
  std::vector<ControlPoint> points;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    const auto begin_ns = static_cast<std::int64_t>(k) * kSampleNs;
    points.push_back({begin_ns, gains[k]});
    points.push_back({begin_ns + kSampleNs, gains[k]});
  }
  return GainFunction(std::move(points));
}

// Eight pixels that all see the same codes.
struct Sequence {
  std::uint32_t white_code = 128;  // light is the code over it: a power of two, to which nothing is lost
  std::vector<double> gains;
  std::vector<std::uint32_t> codes;

  void add(double gain, std::uint32_t code) {
    gains.push_back(gain);
    codes.push_back(code);
  }
  [[nodiscard]] MemoryCapture capture(std::uint32_t block_samples) const {
    const CaptureFormat format{.shape = {8, 1, 1},
                               .code_bytes = white_code > 255 ? 2u : 1u,
                               .white_code = white_code,
                               .transfer = Transfer::linear()};
    Rasters rasters(codes.size(), std::vector<std::byte>(format.sample_bytes()));
    for (std::size_t k = 0; k < codes.size(); ++k) {
      for (std::uint64_t pixel = 0; pixel < 8; ++pixel) set_code(format, rasters[k], pixel, codes[k]);
    }
    return {format, timeline_of(codes.size()), rasters, block_samples, TilePolicy::dense};
  }
  // To 64 bits: a thousandth of what any bound is here.
  [[nodiscard]] long double light() const {
    long double sum = 0;
    for (std::size_t k = 0; k < codes.size(); ++k) sum += static_cast<long double>(gains[k]) * codes[k];
    return sum / white_code / static_cast<long double>(codes.size());
  }
};

OpenClRenderer renderer_of(Precision precision, bool fuses) {
  OpenClOptions options = renderer_options(precision);
  options.use_fma = fuses;
  return OpenClRenderer(options);
}

// The signed error of a sequence's light, in its bound.
double share_of_sequence(const Sequence& sequence, Precision precision, bool fuses,
                      std::uint32_t block_samples) {
  MemoryCapture capture = sequence.capture(block_samples);
  const RenderPlan plan = make_plan(capture, {{0, steps(sequence.gains)}}, Mask::uniform(8, 1, 0), {});
  OpenClRenderer renderer = renderer_of(precision, fuses);
  const Picture light = renderer.render(plan, capture, kLight).picture;
  const auto error = static_cast<double>(light.values<double>()[0] - sequence.light());
  return error / error_bound(plan, precision, kLight).functions[0].light;
}

// Holds a sequence to its bound, fused or not, as one block and as blocks of one sample, and to coming near it.
// `sign` is that of the error.
void expect_near_bound(const Sequence& sequence, Precision precision, double sign, const char* what) {
  for (const bool fuses : {true, false}) {
    if (fuses && precision == Precision::fixed) continue;
    for (const std::uint32_t block_samples : {1u, 4096u}) {
      const double share = share_of_sequence(sequence, precision, fuses, block_samples);
      std::printf("%s, %s, blocks of at most %u, %s: %+.3f of the bound\n", to_text(precision).c_str(), what,
                  block_samples, fuses ? "fused" : "not fused", share);
      EXPECT_LE(std::fabs(share), 1.0) << what;
      EXPECT_GE(share * sign, 1.0 / 3) << what << ": the bound is looser than it need be";
    }
  }
}

// A sum that stays just above 1 while `pattern`, in its own units of roundoff, is added again and again. A first sample
// and one that cancels it keep boundaries small, so that sums are nearly all of the bound.
Sequence piled_on(double first, const std::vector<double>& pattern) {
  constexpr std::size_t kSamples = 2048;
  Sequence sequence;
  sequence.add(first, 128);
  sequence.add(-1.0, 0);
  while (sequence.codes.size() < kSamples) {
    sequence.add(pattern[sequence.codes.size() % pattern.size()], 128);
  }
  return sequence;
}

// Each term is just less than half of the sum's last place, and lost; or just more, and taken for all of it.
TEST(Roundings, OfSumsInFloatsAndDoublesReachTheBound) {
  for (const auto& [precision, u] : {std::pair{Precision::single_, 0x1p-24}, {Precision::double_, 0x1p-53}}) {
    if (!has(precision)) continue;
    expect_near_bound(piled_on(1.0, {0.98 * u}), precision, -1, "terms that are lost");
    expect_near_bound(piled_on(1.0, {1.02 * u}), precision, +1, "terms that count double");
  }
}

// Both roundings of low parts fall the same way. With the sum at 1 + n 2u, its low part alternates between -3/4 u and
// 1/2 u: the term's low part is half a last place of what it is added to, less a bit, and the sum of that and what
// high parts leave over is a tie.
TEST(Roundings, OfPairsReachTheBound) {
  constexpr double u = 0x1p-24;
  expect_near_bound(piled_on(1 + 1.25 * u, {1.25 * u + 1.49 * u * u, 0.75 * u + 1.49 * u * u}),
                    Precision::compensated, -1, "low parts rounded down");
  expect_near_bound(piled_on(1 + 1.25 * u, {1.25 * u - 1.49 * u * u, 0.75 * u - u * u}),
                    Precision::compensated, +1, "low parts rounded up");
}

// One sample: its weight is rounded, and its product with light. 257 · (1 + 126.49 · 2^-23) is 257 and 126.98 of its
// last places, 126.49 once the weight is rounded.
TEST(Roundings, OfWeightAndProductReachTheBoundOfSingle) {
  Sequence sequence;
  sequence.white_code = 257;
  sequence.add(1 + 126.49 * 0x1p-23, 257);
  expect_near_bound(sequence, Precision::single_, -1, "a weight and a product");
}

// Boundaries half way between whole numbers are rounded up and down by turns, and only the samples between are white.
TEST(Roundings, OfBoundariesReachTheBoundOfFixed) {
  constexpr std::size_t kSamples = 256;
  Sequence sequence;
  sequence.white_code = 32'768;
  const double whole = 0x1p46 - 0x1p12;  // in units of what boundaries are rounded to
  sequence.add(std::scalbn(whole + 0.53, -46), sequence.white_code);
  while (sequence.codes.size() < kSamples) {
    const bool is_white = sequence.codes.size() % 2 == 0;
    sequence.add(std::scalbn(is_white ? 2.06 : 1.94, -46), is_white ? sequence.white_code : 0);
  }
  expect_near_bound(sequence, Precision::fixed, +1, "boundaries by turns");
}

// One sample shows every code, and the one counts whose light errs most: by a curve, by pieces or by a table.
TEST(Roundings, OfLightReachTheBounds) {
  CaptureFormat format{.shape = {256, 256, 1}, .code_bytes = 2, .white_code = 65'535};
  Rasters rasters(1, std::vector<std::byte>(format.sample_bytes()));
  for (std::uint32_t code = 0; code < 65'536; ++code) set_code(format, rasters[0], code, code);
  // Held exactly by floats, so that only products round, and above 1, so that those of bright codes round most.
  const GainFunction function = steps({1.0625});
  for (const Precision precision : {Precision::single_, Precision::fixed}) {
    double most = 0.0;
    for (const Transfer& transfer : {Transfer::srgb(), Transfer::bt709(), Transfer::gamma(2.2)}) {
      format.transfer = transfer;
      MemoryCapture capture(format, timeline_of(1), rasters, 64);
      const RenderPlan plan = make_plan(capture, {{0, function}}, Mask::uniform(256, 256, 0), {});
      const Picture expected = ReferenceRenderer().render(plan, capture, kLight).picture;
      for (const bool permutes : {true, false}) {
        if (permutes && (precision == Precision::fixed || !transfer.toe())) continue;
        OpenClOptions options = renderer_options(precision);
        if (permutes) options.item_pixels = 64, options.lanes = 16;
        options.permutes_pieces = permutes;
        const Picture light = OpenClRenderer(options).render(plan, capture, kLight).picture;
        const double share = share_of_bound(plan, precision, light, expected).worst;
        std::printf("%s, light of %s%s: %.3f of the bound\n", to_text(precision).c_str(),
                    transfer.text().c_str(), permutes ? " in pieces" : "", share);
        EXPECT_LE(share, 1.0) << transfer.text();
        most = std::max(most, share);
      }
    }
    EXPECT_GE(most, 1.0 / 3) << to_text(precision) << ": the bound is looser than it need be";
  }
}

// 3 · 11184811 is 2^25 + 1. Rounded on its own that is 2^25, half of the last place of the sum that it is added to,
// which stays; added at once it is more, and the sum grows. Compilers must do what is written (FP_CONTRACT). A device
// that would emulate fma() is not asked for it.
TEST(Roundings, OfProductsAreThoseThatAreWritten) {
  Sequence sequence;
  sequence.add(1.0, 128);
  sequence.add(std::scalbn(11'184'811.0, 7 - 24 - 25), 3);
  const bool can_fuse = (all_devices().front().getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_FMA) != 0;
  for (const bool fuses : {true, false}) {
    OpenClRenderer renderer = renderer_of(Precision::single_, fuses);
    MemoryCapture capture = sequence.capture(64);
    const RenderPlan plan = make_plan(capture, {{0, steps(sequence.gains)}}, Mask::uniform(8, 1, 0), {});
    const Picture light = renderer.render(plan, capture, kLight).picture;
    EXPECT_EQ(light.values<double>()[0], fuses && can_fuse ? 0.5 + 0x1p-24 : 0.5) << (fuses ? "fused" : "not fused");
  }
}

// Weights and light of so few digits that no sum of them has more than an arithmetic holds.
class ExactSums : public OfPrecision {
 protected:
  static constexpr std::size_t kSamples = 64;
  static constexpr std::uint32_t kWhite = 128;
  static constexpr Shape kShape{40, 8, 1};

  // Bits of any sum. Of pairs a few less than their 48, for their low parts are added before they are normal.
  static int digits() {
    switch (GetParam()) {
      case Precision::single_: return 24;
      case Precision::compensated: return 45;
      case Precision::double_:
      case Precision::fixed: break;
    }
    return 53;
  }

  static CaptureFormat format() { return {.shape = kShape, .white_code = kWhite, .transfer = Transfer::linear()}; }
};

TEST_P(ExactSums, ComeOutExactly) {
  Random random(3);
  const Rasters rasters = random_rasters(random, format(), kSamples);
  // Whole numbers in units of the last digit, 128 · 64 of the largest of which fill all digits.
  const double largest = std::scalbn(1.0, digits() - 13) - 1;
  std::vector<double> weights, gains;
  for (std::size_t k = 0; k < kSamples; ++k) {
    weights.push_back(std::floor(random.real(1.0, largest)) * (k % 5 == 3 ? -1 : 1));
    gains.push_back(std::scalbn(weights.back(), -30));
  }
  std::size_t values = 0;
  for (const bool fuses : {true, false}) {
    if (fuses && GetParam() == Precision::fixed) continue;
    OpenClRenderer renderer = renderer_of(GetParam(), fuses);
    for (const TilePolicy policy : {TilePolicy::dense, TilePolicy::rows, TilePolicy::records}) {
      for (const std::uint32_t block_samples : {7u, 64u}) {
        MemoryCapture capture(format(), timeline_of(kSamples), rasters, block_samples, policy);
        const RenderPlan plan =
            make_plan(capture, {{0, steps(gains)}}, Mask::uniform(kShape.width, kShape.height, 0), {});
        const Picture light = renderer.render(plan, capture, kLight).picture;
        for (std::uint64_t i = 0; i < kShape.value_count(); ++i) {
          double sum = 0.0;  // whole, and less than 2^53: exact
          for (std::size_t k = 0; k < kSamples; ++k) sum += weights[k] * code_at(format(), rasters[k], i);
          ASSERT_EQ(light.values<double>()[i], std::scalbn(sum, -30 - 6 - 7))
              << "value " << i << ", tiles " << to_text(policy) << ", blocks of " << block_samples
              << (fuses ? "" : ", not fused") << "; rerun: " << rerun();
          ++values;
        }
      }
    }
  }
  std::printf("%zu values of up to %d bits, all exact\n", values, digits());
}

INSTANTIATE_TEST_SUITE_P(, ExactSums, testing::ValuesIn(kPrecisions),
                         [](const auto& instance) { return to_text(instance.param); });

}  // namespace
}  // namespace nutik::test
