#include "opencl/kernel_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/fixed_scale.hpp"

namespace nutik {
namespace {

// How kernels find the code of a light value: a guess from the light's square root, and one comparison.

struct CodeSearch {
  // Least light of each code of the picture, as the kernel compares with it; the first is 0.
  std::vector<double> thresholds;
  // For each of as many equal steps of √(light / white) the code at its start, or the one below: no step holds
  // more than one threshold, roundings of the device's square root included.
  std::vector<std::uint32_t> guesses;
};

// Least light of each code, where light 1 is `white_light`, correctly rounded where light is linear.
std::vector<double> code_thresholds(const Transfer& transfer, std::uint32_t white_code, double white_light) {
  std::vector<double> thresholds = transfer.code_thresholds(white_code);
  for (std::size_t code = 1; code < thresholds.size(); ++code) {
    thresholds[code] = transfer.is_linear() ? (static_cast<double>(code) - 0.5) * white_light / white_code
                                            : thresholds[code] * white_light;
  }
  return thresholds;
}

// `thresholds` increase from 0 to at most white_light; guesses are made in arithmetic of unit roundoff
// `roundoff`. None where codes lie too close to be told apart by one comparison: beyond 2^22 steps (a gamma above 3 or
// so, or PQ, whose first codes hardly differ in light).
std::optional<CodeSearch> code_search(std::vector<double> thresholds, double white_light, double roundoff) {
  constexpr std::uint32_t kMaxGuesses = 1u << 22;
  const double slack = 16 * roundoff;  // the device's √ times the number of steps errs by less
  const std::size_t white_code = thresholds.size() - 1;
  CodeSearch search{std::move(thresholds), {}};
  for (std::uint32_t steps = 1024; steps <= kMaxGuesses; steps *= 2) {
    search.guesses.assign(steps, 0);
    std::size_t code = 0;
    bool fits = true;
    for (std::uint32_t i = 0; i < steps && fits; ++i) {
      const auto root_before = [&](std::size_t c) { return std::sqrt(search.thresholds[c] / white_light) * steps; };
      const double begin = i - slack * steps;
      const double end = i + 1 + slack * steps;
      while (code < white_code && root_before(code + 1) <= begin) ++code;
      search.guesses[i] = static_cast<std::uint32_t>(code);
      fits = code + 2 > white_code || root_before(code + 2) > end;
    }
    if (fits) return search;
  }
  return std::nullopt;
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();

template <typename Values>
Bytes bytes_of(const Values& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

template <typename To, typename Values, typename Convert>
Bytes converted(const Values& values, Convert convert) {
  std::vector<To> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), convert);
  return bytes_of(result);
}

// 2^exponent as two factors that are finite and not 0, each a number of `Real`. Exponents beyond what two hold
// are cut: sums are scaled by them only to codes, which are black or white long before.
template <typename Real>
LightScale<Real> power_of_two(int exponent) {
  constexpr int kMax = std::numeric_limits<Real>::max_exponent - 1;
  const int inside = std::clamp(exponent, -2 * (kMax - 1), 2 * kMax);
  const int half = inside / 2;
  return {std::scalbn(Real{1}, half), std::scalbn(Real{1}, inside - half)};
}

double white_light_of(const Transfer& transfer, std::uint32_t white_code) {
  return transfer.is_linear() ? white_code : 1.0;
}

template <typename Real>
Bytes floating_scales(const RenderPlan& plan) {
  return converted<LightScale<Real>>(
      plan.functions, [](const PlannedFunction& function) { return power_of_two<Real>(function.summary.exponent); });
}

// Onto the scale of the thresholds, or so many bits below it.
Bytes fixed_scales(const RenderPlan& plan, const FixedScale& scale, int bits_below) {
  std::vector<FixedLightScale> scales;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    const int left =
        plan.functions[f].summary.exponent - scale.exponents[f] + kCodeBits - scale.light_bits - bits_below;
    scales.push_back(
        {static_cast<std::uint32_t>(std::clamp(left, 0, 63)), static_cast<std::uint32_t>(std::clamp(-left, 0, 63))});
  }
  return bytes_of(scales);
}

std::optional<CodeTables> floating_code_tables(const CodeKey& key) {
  std::vector<double> thresholds = code_thresholds(key.transfer, key.white_code, key.white_light);
  const bool is_double = key.precision == Precision::double_;
  if (key.precision == Precision::single_) {
    for (double& threshold : thresholds) threshold = static_cast<float>(threshold);
  } else if (!is_double) {
    for (double& threshold : thresholds) threshold = value_of(pair_of(threshold));
  }
  auto search = code_search(std::move(thresholds), key.white_light, is_double ? 0x1p-53 : 0x1p-24);
  if (!search) return std::nullopt;
  search->thresholds.front() = key.white_light;
  search->thresholds.push_back(kInfinite);
  return CodeTables{numbers_of(search->thresholds, key.precision), std::move(search->guesses)};
}

std::optional<CodeTables> fixed_code_tables(const CodeKey& key) {
  std::vector<double> thresholds = code_thresholds(key.transfer, key.white_code, key.white_light);
  for (double& threshold : thresholds) threshold = std::ceil(threshold);
  auto search = code_search(std::move(thresholds), key.white_light, 0x1p-24);
  if (!search) return std::nullopt;
  search->thresholds.front() = key.white_light;
  search->thresholds.push_back(0x1p63);
  return CodeTables{
      converted<std::uint64_t>(search->thresholds, [](double value) { return static_cast<std::uint64_t>(value); }),
      std::move(search->guesses)};
}

}  // namespace

FloatPair pair_of(double number) {
  const auto high = static_cast<float>(number);
  return {high, std::isinf(high) ? 0.0f : static_cast<float>(number - high)};
}

Bytes numbers_of(std::span<const double> values, Precision precision) {
  switch (precision) {
    case Precision::single_: return converted<float>(values, [](double value) { return static_cast<float>(value); });
    case Precision::compensated: return converted<FloatPair>(values, pair_of);
    case Precision::double_:
    case Precision::fixed: break;
  }
  return bytes_of(values);
}

Bytes light_values(const LightSource& light, Precision precision, std::uint64_t white_light) {
  if (precision != Precision::fixed) {
    // Byte 0 of the light of each code, byte 1, 2, 3; then the values.
    const Bytes whole = numbers_of(light.bytewise, precision), values = numbers_of(light.values, precision);
    Bytes bytes(whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) bytes[i % 4 * 256 + i / 4] = whole[i];
    bytes.insert(bytes.end(), values.begin(), values.end());
    return bytes;
  }
  const auto white = static_cast<double>(white_light);
  return converted<std::uint32_t>(light.values,
                                  [&](double value) { return static_cast<std::uint32_t>(std::llrint(value * white)); });
}

Bytes light_scales(const RenderPlan& plan, Precision precision) {
  switch (precision) {
    case Precision::single_:
    case Precision::compensated: return floating_scales<float>(plan);
    case Precision::double_: return floating_scales<double>(plan);
    case Precision::fixed: break;
  }
  return fixed_scales(plan, fixed_scale(plan), 0);
}

std::vector<LightFactors> light_factors(const RenderPlan& plan, Precision precision) {
  const FixedScale scale = precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
  std::vector<LightFactors> factors;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    factors.push_back({precision == Precision::fixed
                           ? scale.light_factor(f)
                           : 1.0 / white_light_of(plan.capture.transfer, plan.capture.white_code),
                       power_of_two<double>(plan.functions[f].summary.exponent)});
  }
  return factors;
}

Bytes blend_scales(const RenderPlan& plan, Precision precision) {
  if (precision != Precision::fixed) return light_scales(plan, precision);
  const FixedScale scale = fixed_scale(plan);
  return fixed_scales(plan, scale, scale.blend_shift);
}

std::uint32_t blend_shift(const RenderPlan& plan, Precision precision) {
  return precision == Precision::fixed ? static_cast<std::uint32_t>(fixed_scale(plan).blend_shift) : 0;
}

CodeKey CodeKey::of(const RenderPlan& plan, Precision precision, const OutputFormat& output) {
  const CodeMaking making = CodeMaking::of(plan.capture, output);
  double white_light = white_light_of(plan.capture.transfer, plan.capture.white_code);
  if (precision == Precision::fixed) {
    const FixedScale scale = fixed_scale(plan);
    white_light = std::scalbn(static_cast<double>(scale.white_light), kCodeBits - scale.light_bits);
  }
  return {making.transfer, output.white_code, white_light * making.white_light, precision};
}

std::optional<CodeTables> code_tables(const CodeKey& key) {
  return key.precision == Precision::fixed ? fixed_code_tables(key) : floating_code_tables(key);
}

Bytes code_limits(const CodeKey& key, const CodeScale& scale, const RenderPlan& plan) {
  const auto [lowest, highest] = scale.limits();
  std::array limits{lowest * key.white_light, highest * key.white_light};
  if (key.precision == Precision::fixed) {
    const int shift = fixed_scale(plan).blend_shift;
    std::array<std::int64_t, 2> whole{};
    std::ranges::transform(limits, whole.begin(), [&](double limit) {
      return static_cast<std::int64_t>(std::ceil(std::scalbn(limit, -shift)));
    });
    return bytes_of(whole);
  }
  if (key.precision == Precision::single_) {
    // Less than a number is less than the next float from it on, and nothing else.
    for (double& limit : limits) {
      const auto near = static_cast<float>(limit);
      limit = near < limit ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
    }
  }
  return numbers_of(limits, key.precision);
}

}  // namespace nutik
