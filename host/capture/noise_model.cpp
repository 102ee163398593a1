#include "capture/noise_model.hpp"

#include <algorithm>
#include <cmath>

namespace nutik {
namespace {

double odd_fraction_of(const Transfer& transfer, double light) {
  return light < 0 ? -transfer.fraction_of(-light) : transfer.fraction_of(light);
}

double interpolate(const std::vector<NoisePoint>& points, double code) {
  const auto after = std::ranges::lower_bound(points, code, {}, &NoisePoint::code);
  if (after == points.begin()) return points.front().sd;
  if (after == points.end()) return points.back().sd;
  const NoisePoint& before = *(after - 1);
  const double share = (code - before.code) / (after->code - before.code);
  return std::lerp(before.sd, after->sd, share);
}

}  // namespace

std::string_view to_text(NoiseCurve curve) { return curve == NoiseCurve::sensor ? "sensor" : "points"; }

double code_sd_of(double light_sd, double code, std::uint32_t white_code, const Transfer& transfer) {
  const double light = transfer.light_of(code / white_code);
  const double reach =
      odd_fraction_of(transfer, light + light_sd) - odd_fraction_of(transfer, light - light_sd);
  return std::hypot(reach / 2 * white_code, std::sqrt(kRoundingVariance));
}

double light_sd_of(double code_sd, double code, std::uint32_t white_code, const Transfer& transfer) {
  double low = 0, high = 1;
  while (code_sd_of(high, code, white_code, transfer) < code_sd) high *= 2;
  // The standard deviation in codes grows with the one in light; halving a double's range takes 64 steps.
  for (int step = 0; step < 64; ++step) {
    const double middle = (low + high) / 2;
    (code_sd_of(middle, code, white_code, transfer) < code_sd ? low : high) = middle;
  }
  return low;
}

double CameraNoise::sd(std::uint32_t channel, double code) const {
  const ChannelNoise& noise = channels[channel];
  if (noise.curve == NoiseCurve::points) return interpolate(noise.points, code);
  const double light = transfer.light_of(code / white_code);
  return code_sd_of(std::sqrt(noise.read * noise.read + noise.shot * light), code, white_code, transfer);
}

std::vector<float> CameraNoise::sd_of_codes(std::uint32_t channel) const {
  std::vector<float> table(std::size_t{white_code} + 1);
  for (std::size_t code = 0; code < table.size(); ++code) {
    table[code] = static_cast<float>(sd(channel, static_cast<double>(code)));
  }
  return table;
}

}  // namespace nutik
