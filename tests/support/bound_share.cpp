#include "support/bound_share.hpp"

#include <algorithm>
#include <cmath>

namespace nutik::test {
namespace {

double value_of(const Picture& picture, std::uint64_t i) {
  switch (picture.type) {
    case ValueType::code8: return picture.values<std::uint8_t>()[i];
    case ValueType::code16: return picture.values<std::uint16_t>()[i];
    case ValueType::light32: return picture.values<float>()[i];
    case ValueType::light64: break;
  }
  return picture.values<double>()[i];
}

// Where light lies on the scale of codes, between two of them; docs/model.md.
double place_of(const Transfer& transfer, const OutputFormat& output, double light) {
  const double white = output.white_code;
  const double magnitude = transfer.fraction_of(std::min(std::fabs(light), 1.0));
  switch (output.negative) {
    case NegativeLight::saturate: return light < 0.0 ? 0.0 : magnitude * white;
    case NegativeLight::absolute: return magnitude * white;
    case NegativeLight::offset: break;
  }
  const double half = std::floor(white / 2);
  return white - half + std::copysign(magnitude * half, light);
}

// In codes, or in light.
double share_of(const Transfer& transfer, const PictureError& error, const OutputFormat& output, double value,
                double light) {
  if (holds_codes(output.type)) {
    // The place is itself computed to 32 u₆₄.
    const double allowed = error.steps + 32 * kRoundoff64 * output.white_code;
    return (std::fabs(value - place_of(transfer, output, light)) - 0.5) / allowed;
  }
  const double distance = std::fabs(value - light);
  const double rounding =
      output.type == ValueType::light32 ? std::max(std::fabs(value) * 0x1p-24, 0x1p-150) : 0.0;
  return distance <= rounding ? 0.0 : (distance - rounding) / error.light;
}

}  // namespace

Difference share_of_bound(const RenderPlan& plan, const ErrorBound& bound, const OutputFormat& output,
                          const Picture& picture, const Picture& light) {
  Difference difference;
  for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
    const std::size_t function = plan.function_of(i / picture.shape.channels);
    double share = share_of(plan.capture.transfer, bound.functions[function], output, value_of(picture, i),
                            light.values<double>()[i]);
    if (std::isnan(share)) share = INFINITY;
    if (share > difference.worst) difference = {share, i};
  }
  return difference;
}

}  // namespace nutik::test
