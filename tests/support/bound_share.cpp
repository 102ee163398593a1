#include "support/bound_share.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "support/chromaticity.hpp"

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

// Where light lies on the scale of codes, between two of them; docs/explanation/model.md.
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
  return distance <= rounding ? 0.0 : (distance - rounding) / error.of_light(light);
}

// Light as the codes of `output` are made of it: white is 1, in BT.709's primaries if it is to be seen.
std::vector<double> shown(const CaptureFormat& capture, const OutputFormat& output,
                          std::span<const double> light) {
  std::vector<double> result(light.begin(), light.end());
  if (!holds_codes(output.type) || !output.transfer) return result;
  // ITU-R BT.2408: 75 % of HLG, 203 of 10 000 cd/m².
  const double white = capture.transfer == Transfer::hlg()  ? capture.transfer.light_of(0.75)
                       : capture.transfer == Transfer::pq() ? 203.0 / 10'000
                                                            : 1.0;
  for (double& value : result) value /= white;
  if (capture.shape.channels == 1) return result;
  const Matrix from = to_xyz(chromaticities(capture.primaries));
  const Matrix to = to_xyz(chromaticities(Primaries::bt709));
  for (std::size_t i = 0; i + 2 < result.size(); i += 3) {
    std::array<double, 3> xyz{};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t channel = 0; channel < 3; ++channel)
        xyz[row] += from[row][channel] * result[i + channel];
    }
    if (capture.primaries != Primaries::bt709)
      std::ranges::copy(solved(to, xyz), result.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return result;
}

}  // namespace

Difference share_of_bound(const RenderPlan& plan, const ErrorBound& bound, const OutputFormat& output,
                          const Picture& picture, const Picture& light) {
  Difference difference;
  const PixelErrors bounds(plan, bound);
  const Transfer transfer = output.transfer.value_or(plan.capture.transfer);
  const std::vector<double> seen = shown(plan.capture, output, light.values<double>());
  for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
    double share =
        share_of(transfer, bounds.of(i / picture.shape.channels), output, value_of(picture, i), seen[i]);
    if (std::isnan(share)) share = INFINITY;
    if (share > difference.worst) difference = {share, i};
  }
  return difference;
}

}  // namespace nutik::test
