#include "opencl/kernel_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "opencl/code_search.hpp"
#include "opencl/kernel_layout.hpp"
#include "render/fixed_scale.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// What white is in the kernel's fixed light, at most: leaves room for a sum that is larger.
constexpr int kFixedLightBits = 61;

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

FloatPair pair_of(double number) {
  const auto high = static_cast<float>(number);
  return {high, std::isinf(high) ? 0.0f : static_cast<float>(number - high)};
}

double value_of(const FloatPair& pair) { return static_cast<double>(pair.high) + pair.low; }

Bytes numbers_of(std::span<const double> values, Precision precision) {
  switch (precision) {
    case Precision::single_:
      return converted<float>(values, [](double value) { return static_cast<float>(value); });
    case Precision::compensated: return converted<FloatPair>(values, pair_of);
    case Precision::double_:
    case Precision::fixed: break;
  }
  return bytes_of(values);
}

// 2^exponent as two factors that are finite and not 0, each a number of `Real`. Exponents beyond what two hold
// are cut: sums are scaled by them only to codes, which are black or white long before.
template <typename Real>
LightScale<Real> power_of_two(int exponent) {
  constexpr int kMost = std::numeric_limits<Real>::max_exponent - 1;
  const int inside = std::clamp(exponent, -2 * (kMost - 1), 2 * kMost);
  const int half = inside / 2;
  return {std::scalbn(Real{1}, half), std::scalbn(Real{1}, inside - half)};
}

double white_light_of(const RenderPlan& plan) {
  return plan.capture.transfer.is_linear() ? plan.capture.white_code : 1.0;
}

template <typename Real>
Bytes light_scales(const RenderPlan& plan) {
  return converted<LightScale<Real>>(plan.functions, [](const PlannedFunction& function) {
    return power_of_two<Real>(function.summary.exponent);
  });
}

CodeTables floating_code_tables(const RenderPlan& plan, Precision precision, std::uint32_t white_code) {
  const double white_light = white_light_of(plan);
  std::vector<double> thresholds = code_thresholds(plan.capture.transfer, white_code, white_light);
  const bool is_double = precision == Precision::double_;
  if (precision == Precision::single_) {
    for (double& threshold : thresholds) threshold = static_cast<float>(threshold);
  } else if (!is_double) {
    for (double& threshold : thresholds) threshold = value_of(pair_of(threshold));
  }
  CodeSearch search =
      code_search(std::move(thresholds), white_light, is_double ? 0x1p-53 : 0x1p-24, plan.capture.transfer);
  search.thresholds.front() = white_light;
  search.thresholds.push_back(kInfinite);
  return {is_double ? light_scales<double>(plan) : light_scales<float>(plan),
          numbers_of(search.thresholds, precision), std::move(search.guesses)};
}

CodeTables fixed_code_tables(const RenderPlan& plan, std::uint32_t white_code) {
  const FixedScale scale = fixed_scale(plan);
  const int more_bits = kFixedLightBits - scale.light_bits;
  const double white_light = std::scalbn(static_cast<double>(scale.white_light), more_bits);
  std::vector<double> thresholds = code_thresholds(plan.capture.transfer, white_code, white_light);
  for (double& threshold : thresholds) threshold = std::ceil(threshold);
  CodeSearch search = code_search(std::move(thresholds), white_light, 0x1p-24, plan.capture.transfer);
  search.thresholds.front() = white_light;
  search.thresholds.push_back(0x1p63);
  std::vector<FixedLightScale> scales;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    const int left = plan.functions[f].summary.exponent - scale.exponents[f] + more_bits;
    scales.push_back({static_cast<std::uint32_t>(std::clamp(left, 0, 63)),
                      static_cast<std::uint32_t>(std::clamp(-left, 0, 63))});
  }
  return {bytes_of(scales),
          converted<std::uint64_t>(search.thresholds,
                                   [](double value) { return static_cast<std::uint64_t>(value); }),
          std::move(search.guesses)};
}

FixedScale scale_of(const RenderPlan& plan, Precision precision) {
  return precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
}

// light = sum · factor · first · second
struct Factors {
  double factor;
  LightScale<double> exponent;
};

std::vector<Factors> factors_of(const RenderPlan& plan, Precision precision) {
  const FixedScale scale = scale_of(plan, precision);
  std::vector<Factors> factors;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    factors.push_back({precision == Precision::fixed ? scale.light_factor(f) : 1.0 / white_light_of(plan),
                       power_of_two<double>(plan.functions[f].summary.exponent)});
  }
  return factors;
}

double sum_at(std::span<const std::byte> raster, Precision precision, std::uint64_t value) {
  const auto read = [&]<typename T>(T number) {
    std::memcpy(&number, raster.data() + value * sizeof number, sizeof number);
    return number;
  };
  switch (precision) {
    case Precision::single_: return read(float{});
    case Precision::compensated: return value_of(read(FloatPair{}));
    case Precision::double_: return read(double{});
    case Precision::fixed: return static_cast<double>(read(std::int64_t{}));
  }
  return 0.0;
}

template <typename Value>
void store_as(const RenderPlan& plan, const Rectangle& rectangle, Precision precision,
              std::span<const std::byte> raster, std::span<Value> values) {
  const std::vector<Factors> factors = factors_of(plan, precision);
  const std::uint32_t channels = plan.capture.shape.channels;
  parallel_for(rectangle.height, [&](std::uint64_t row) {
    const std::uint8_t* functions =
        plan.function_of_pixel.data() + (rectangle.y + row) * plan.capture.shape.width + rectangle.x;
    std::uint64_t i = row * rectangle.width * channels;
    for (std::uint32_t column = 0; column < rectangle.width; ++column) {
      const Factors& light = factors[functions[column]];
      for (std::uint32_t channel = 0; channel < channels; ++channel, ++i) {
        values[i] = static_cast<Value>(sum_at(raster, precision, i) * light.factor * light.exponent.first *
                                       light.exponent.second);
      }
    }
  });
}

}  // namespace

ExposureTables::ExposureTables(const RenderPlan& plan, Precision precision)
    : plan_(plan), precision_(precision), scale_(scale_of(plan, precision)), sweep_(plan, scale_) {}

WeightTables ExposureTables::pack(const TableSlice& slice) {
  if (precision_ == Precision::fixed) {
    const FixedTables tables = sweep_.pack(slice.last_block);
    return {bytes_of(tables.weights), bytes_of(tables.boundaries)};
  }
  const auto rows = [&](const std::vector<double>& table) {
    return std::span(table).subspan(slice.first_row * plan_.function_count(),
                                    (slice.last_row - slice.first_row) * plan_.function_count());
  };
  return {numbers_of(rows(plan_.weights), precision_), numbers_of(rows(plan_.boundaries), precision_)};
}

Bytes ExposureTables::light(const LightSource& light) const {
  if (precision_ != Precision::fixed) return numbers_of(light.values, precision_);
  const auto white = static_cast<double>(scale_.white_light);
  return converted<std::uint32_t>(
      light.values, [&](double value) { return static_cast<std::uint32_t>(std::llrint(value * white)); });
}

CodeTables code_tables(const RenderPlan& plan, Precision precision, std::uint32_t white_code) {
  return precision == Precision::fixed ? fixed_code_tables(plan, white_code)
                                       : floating_code_tables(plan, precision, white_code);
}

void store_light(const RenderPlan& plan, const Rectangle& rectangle, Precision precision,
                 std::span<const std::byte> raster, Picture& picture) {
  if (picture.type == ValueType::light32) {
    store_as(plan, rectangle, precision, raster, picture.values<float>());
  } else {
    store_as(plan, rectangle, precision, raster, picture.values<double>());
  }
}

}  // namespace nutik
