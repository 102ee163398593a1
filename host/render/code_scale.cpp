#include "render/code_scale.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#include "system/parallel.hpp"

namespace nutik {
namespace {

// Values that one thread takes at a time.
constexpr std::uint64_t kPart = 1u << 16;

// Where few lights differ, finding a code again takes less time than a power; where all do, an eighth is lost.
template <typename Code>
void encode(const Picture& light, const CodeScale& scale, bool has_few_lights, Picture& codes) {
  struct Known {
    double light = std::numeric_limits<double>::quiet_NaN();
    Code code = 0;
  };
  constexpr int kKnownBits = 10;
  const auto from = light.values<double>();
  const auto to = codes.values<Code>();
  parallel_for_parts(from.size(), kPart, [&](std::uint64_t first, std::uint64_t last) {
    if (!has_few_lights) {
      for (std::uint64_t i = first; i < last; ++i) to[i] = static_cast<Code>(scale.code_of(from[i]));
      return;
    }
    std::array<Known, std::size_t{1} << kKnownBits> known;
    for (std::uint64_t i = first; i < last; ++i) {
      Known& before = known[std::bit_cast<std::uint64_t>(from[i]) * 0x9e3779b97f4a7c15u >> (64 - kKnownBits)];
      if (before.light != from[i]) before = {from[i], static_cast<Code>(scale.code_of(from[i]))};
      to[i] = before.code;
    }
  });
}

}  // namespace

CodeScale::CodeScale(const Transfer& transfer, const OutputFormat& output)
    : transfer_(transfer),
      white_code_(output.white_code),
      negative_(output.negative),
      half_(std::max(output.white_code / 2, 1u)),
      folds_(output.negative == NegativeLight::absolute) {
  const double step = 1.0 / output.white_code;
  switch (negative_) {
    case NegativeLight::saturate:
      lowest_ = -transfer.light_of(0.5 * step);
      highest_ = transfer.light_of(1.0 + 0.5 * step);
      break;
    case NegativeLight::offset:
      highest_ = transfer.light_of(1.0 + 0.5 / half_);
      lowest_ = -highest_;
      break;
    case NegativeLight::absolute:
      highest_ = transfer.light_of(1.0 + 0.5 * step);
      lowest_ = -std::numeric_limits<double>::infinity();
      break;
  }
}

std::uint32_t CodeScale::code_of(double light) const {
  const double magnitude =
      negative_ == NegativeLight::saturate ? std::clamp(light, 0.0, 1.0) : std::min(std::fabs(light), 1.0);
  const auto rounded = [&](std::uint32_t codes) {
    return static_cast<std::uint32_t>(std::floor(transfer_.fraction_of(magnitude) * codes + 0.5));
  };
  if (negative_ != NegativeLight::offset) return rounded(white_code_);
  // Light 0 has a code of its own, not the border between two: what cancels must not flicker.
  const std::uint32_t middle = white_code_ - half_;
  return light < 0.0 ? middle - rounded(half_) : middle + rounded(half_);
}

void to_shown_light(Picture& light, const CodeMaking& making) {
  const auto values = light.values<double>();
  if (making.white_light != 1.0) {
    parallel_for_parts(values.size(), kPart, [&](std::uint64_t first, std::uint64_t last) {
      for (std::uint64_t i = first; i < last; ++i) values[i] /= making.white_light;
    });
  }
  if (!making.conversion) return;
  const ColourMatrix& matrix = *making.conversion;
  parallel_for_parts(light.shape.pixel_count(), kPart, [&](std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t pixel = first; pixel < last; ++pixel) {
      double* const of_pixel = &values[pixel * 3];
      const double red = of_pixel[0], green = of_pixel[1], blue = of_pixel[2];
      for (std::size_t row = 0; row < 3; ++row) {
        of_pixel[row] = matrix[row][0] * red + matrix[row][1] * green + matrix[row][2] * blue;
      }
    }
  });
}

Saturation count_saturated(const Picture& light, const CodeScale& scale) {
  const auto values = light.values<double>();
  const std::uint32_t channels = light.shape.channels;
  std::atomic<std::uint64_t> below{0}, above{0};
  parallel_for_parts(light.shape.pixel_count(), kPart, [&](std::uint64_t first, std::uint64_t last) {
    std::uint64_t part_below = 0, part_above = 0;
    for (std::uint64_t pixel = first; pixel < last; ++pixel) {
      const auto of_pixel = values.subspan(pixel * channels, channels);
      part_below += std::ranges::any_of(of_pixel, [&](double value) { return scale.saturates_below(value); });
      part_above += std::ranges::any_of(of_pixel, [&](double value) { return scale.saturates_above(value); });
    }
    below += part_below;
    above += part_above;
  });
  return {below, above};
}

Picture encoded(const Picture& light, const CodeScale& scale, const OutputFormat& output, bool has_few_lights) {
  Picture codes(light.shape, output.type, output.white_code);
  output.type == ValueType::code8 ? encode<std::uint8_t>(light, scale, has_few_lights, codes)
                                  : encode<std::uint16_t>(light, scale, has_few_lights, codes);
  return codes;
}

Picture stored(Picture light, const CaptureFormat& capture, const OutputFormat& output,
               Saturation& saturation, bool has_few_lights) {
  if (output.type == ValueType::light64) return light;
  if (holds_codes(output.type)) {
    const CodeMaking making = CodeMaking::of(capture, output);
    const CodeScale scale(making.transfer, output);
    to_shown_light(light, making);
    saturation += count_saturated(light, scale);
    return encoded(light, scale, output, has_few_lights);
  }
  Picture narrow(light.shape, output.type, output.white_code);
  std::ranges::transform(light.values<double>(), narrow.values<float>().begin(),
                         [](double value) { return static_cast<float>(value); });
  return narrow;
}

void state_values(Picture& picture, const CaptureFormat& capture, const OutputFormat& output) {
  picture.primaries = capture.primaries;
  picture.pixel_aspect = capture.pixel_aspect;
  if (!holds_codes(output.type)) return;
  const CodeMaking making = CodeMaking::of(capture, output);
  picture.transfer = making.transfer;
  picture.primaries = making.primaries;
}

bool can_saturate(const RenderPlan& plan, const CodeMaking& making, const CodeScale& scale) {
  if (making.conversion) return true;  // colours lie outside other primaries
  return std::ranges::any_of(plan.functions, [&](const PlannedFunction& planned) {
    // Light of [0, 1] comes to between -∫g⁻/D and ∫g⁺/D.
    const double sum = planned.summary.error_scale() / making.white_light;
    const double difference = planned.summary.still_gain() / making.white_light;
    return scale.saturates_above((sum + difference) / 2) || scale.saturates_below((difference - sum) / 2) ||
           scale.saturates_above((difference - sum) / 2);
  });
}

}  // namespace nutik
