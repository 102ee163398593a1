#include "opencl/kernel_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "capture/picture.hpp"
#include "render/fixed_scale.hpp"
#include "system/parallel.hpp"

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
      const auto root_before = [&](std::size_t c) {
        return std::sqrt(search.thresholds[c] / white_light) * steps;
      };
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

double value_of(const FloatPair& pair) { return static_cast<double>(pair.high) + pair.low; }

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
  return converted<LightScale<Real>>(plan.functions, [](const PlannedFunction& function) {
    return power_of_two<Real>(function.summary.exponent);
  });
}

// Onto the scale of the thresholds, or so many bits below it.
Bytes fixed_scales(const RenderPlan& plan, const FixedScale& scale, int bits_below) {
  std::vector<FixedLightScale> scales;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    const int left =
        plan.functions[f].summary.exponent - scale.exponents[f] + kCodeBits - scale.light_bits - bits_below;
    scales.push_back({static_cast<std::uint32_t>(std::clamp(left, 0, 63)),
                      static_cast<std::uint32_t>(std::clamp(-left, 0, 63))});
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
  return CodeTables{converted<std::uint64_t>(search->thresholds,
                                             [](double value) { return static_cast<std::uint64_t>(value); }),
                    std::move(search->guesses)};
}

// light = sum · factor · first · second
struct Factors {
  double factor;
  LightScale<double> exponent;
};

std::vector<Factors> factors_of(const RenderPlan& plan, Precision precision) {
  const FixedScale scale = precision == Precision::fixed ? fixed_scale(plan) : FixedScale{};
  std::vector<Factors> factors;
  for (std::size_t f = 0; f < plan.functions.size(); ++f) {
    factors.push_back({precision == Precision::fixed
                           ? scale.light_factor(f)
                           : 1.0 / white_light_of(plan.capture.transfer, plan.capture.white_code),
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

// Value `at` of the first plane of sums by tiles, whose planes lie one behind the other.
double tile_sum(std::span<const std::byte> sums, Precision precision, std::uint64_t at) {
  if (precision != Precision::compensated) return sum_at(sums, precision, at);
  return sum_at(sums, Precision::single_, at) + sum_at(sums, Precision::single_, at + kTilePixels);
}

template <typename Value>
void store_as(const RenderPlan& plan, const Rectangle& rectangle, Precision precision,
              std::span<const std::byte> raster, std::span<Value> values) {
  const std::vector<Factors> factors = factors_of(plan, precision);
  const std::uint32_t channels = plan.capture.shape.channels;
  parallel_for(rectangle.height, [&](std::uint64_t row) {
    const std::uint64_t first_pixel = (rectangle.y + row) * plan.capture.shape.width + rectangle.x;
    std::uint64_t i = row * rectangle.width * channels;
    for (std::uint32_t column = 0; column < rectangle.width; ++column) {
      const Factors& light = factors[plan.map->region_at(first_pixel + column)];
      for (std::uint32_t channel = 0; channel < channels; ++channel, ++i) {
        values[i] = static_cast<Value>(sum_at(raster, precision, i) * light.factor * light.exponent.first *
                                       light.exponent.second);
      }
    }
  });
}

template <typename Value>
void blend_as(const RenderPlan& plan, const FunctionMap& map, const TilesOfBand& tiles, Precision precision,
              std::span<const std::byte> sums, const Rectangle& part, std::span<Value> values) {
  constexpr std::size_t kTilesAtOnce = 64;
  const std::vector<Factors> factors = factors_of(plan, precision);
  const std::uint32_t channels = plan.capture.shape.channels;
  const std::uint32_t plane_values = (precision == Precision::compensated ? 2 : 1) * kTilePixels;
  const TileGrid grid(plan.capture.shape);
  const std::uint32_t first_sums = map.first_of[tiles.first];
  // A channel of a pixel, from the sums of one function.
  const auto light_of = [&](std::uint32_t tile, std::uint32_t lane, std::uint32_t channel) {
    const Factors& light = factors[map.of_lane[std::size_t{tile} * kTilePixels + lane]];
    const std::uint64_t at = (std::uint64_t{tile - first_sums} * channels + channel) * plane_values + lane;
    return tile_sum(sums, precision, at) * light.factor * light.exponent.first * light.exponent.second;
  };
  const auto blended = [&](std::uint32_t first, std::uint32_t last, std::uint32_t lane,
                           std::uint32_t channel) {
    if (last == first + 1) return light_of(first, lane, channel);
    double sum = 0.0;
    for (std::uint32_t tile = first; tile < last; ++tile) {
      const std::uint16_t share = map.shares[std::size_t{tile} * kTilePixels + lane];
      if (share == kWholeShare) return light_of(tile, lane, channel);
      if (share != 0) sum += share * light_of(tile, lane, channel);
    }
    return sum / kWholeShare;
  };
  parallel_for_parts(tiles.last - tiles.first, kTilesAtOnce, [&](std::uint64_t from, std::uint64_t to) {
    for (std::size_t tile = tiles.first + from; tile < tiles.first + to; ++tile) {
      const std::uint32_t first = map.first_of[tile], last = map.first_of[tile + 1];
      const std::uint32_t left = map.tiles[first] % grid.columns() * kTileSide;
      const std::uint32_t top = map.tiles[first] / grid.columns() * kTileSide;
      for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
        const std::uint32_t x = left + lane % kTileSide - part.x, y = top + lane / kTileSide - part.y;
        if (x >= part.width || y >= part.height) continue;  // unsigned: also what lies before it
        Value* const pixel = &values[(std::uint64_t{y} * part.width + x) * channels];
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          pixel[channel] = static_cast<Value>(blended(first, last, lane, channel));
        }
      }
    }
  });
}

}  // namespace

FloatPair pair_of(double number) {
  const auto high = static_cast<float>(number);
  return {high, std::isinf(high) ? 0.0f : static_cast<float>(number - high)};
}

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
  return converted<std::uint32_t>(
      light.values, [&](double value) { return static_cast<std::uint32_t>(std::llrint(value * white)); });
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

void store_light(const RenderPlan& plan, const Rectangle& rectangle, Precision precision,
                 std::span<const std::byte> raster, Picture& picture) {
  if (picture.type == ValueType::light32) {
    store_as(plan, rectangle, precision, raster, picture.values<float>());
  } else {
    store_as(plan, rectangle, precision, raster, picture.values<double>());
  }
}

void blend_light(const RenderPlan& plan, const FunctionMap& map, const TilesOfBand& tiles,
                 Precision precision, std::span<const std::byte> sums, const Rectangle& part,
                 Picture& picture) {
  if (picture.type == ValueType::light32) {
    blend_as(plan, map, tiles, precision, sums, part, picture.values<float>());
  } else {
    blend_as(plan, map, tiles, precision, sums, part, picture.values<double>());
  }
}

}  // namespace nutik
