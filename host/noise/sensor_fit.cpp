#include "noise/sensor_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nutik {
namespace {

constexpr int kFitPasses = 30;
constexpr double kHuber = 2.0;        // uncertainties up to which a point has its full say
constexpr double kModelError = 0.01;  // share of sd to which no camera follows the model

struct LightPoint {
  double light;
  double variance;        // in light
  double relative_error;  // of the variance
};

struct Line {
  double constant = 0;
  double slope = 0;
};

Line weighted_line(std::span<const LightPoint> points, std::span<const double> weights) {
  double w = 0, wl = 0, wll = 0, wv = 0, wlv = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [light, variance, error] = points[i];
    w += weights[i];
    wl += weights[i] * light;
    wll += weights[i] * light * light;
    wv += weights[i] * variance;
    wlv += weights[i] * light * variance;
  }
  const double determinant = w * wll - wl * wl;
  // Points at one light say nothing of the slope; what grows with the light is the usual case.
  const Line only_slope{0, wll > 0 ? wlv / wll : 0}, only_constant{wv / w, 0};
  if (determinant <= 1e-9 * w * wll) return wll > 0 ? only_slope : only_constant;
  const Line line{(wll * wv - wl * wlv) / determinant, (w * wlv - wl * wv) / determinant};
  if (line.constant < 0) return only_slope;
  if (line.slope < 0) return only_constant;
  return line;
}

}  // namespace

SensorFit fit_sensor(std::span<const MeasuredPoint> points, std::uint32_t white_code,
                     const Transfer& transfer) {
  std::vector<LightPoint> in_light;
  std::vector<double> weights;
  for (const auto& [point, uncertainty] : points) {
    const double sd = light_sd_of(point.sd, point.code, white_code, transfer);
    // Rounding is known: what is left when it is taken away has all of the error.
    const double of_light = point.sd * point.sd - kRoundingVariance;
    const double share = std::max(of_light / (point.sd * point.sd), 0.01);
    const double error = 2 * std::hypot(uncertainty, kModelError) / share;
    in_light.push_back({transfer.light_of(point.code / white_code), sd * sd, error});
    weights.push_back(sd > 0 ? 1 / (error * error * sd * sd * sd * sd) : 0);
  }
  if (*std::ranges::max_element(weights) == 0) weights.assign(weights.size(), 1);  // no noise anywhere
  Line line;
  for (int pass = 0; pass < kFitPasses; ++pass) {
    line = weighted_line(in_light, weights);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double expected = line.constant + line.slope * in_light[i].light;
      const double error = in_light[i].relative_error * expected;
      if (error <= 0) continue;
      const double distance = std::abs(in_light[i].variance - expected) / error;
      weights[i] = std::min(1.0, kHuber / std::max(distance, kHuber)) / (error * error);
    }
  }
  SensorFit fit{std::sqrt(line.constant), line.slope, 0, 0};
  std::vector<double> deviations;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const NoisePoint& point = points[i].point;
    const double light_sd = std::sqrt(line.constant + line.slope * in_light[i].light);
    deviations.push_back(std::abs(code_sd_of(light_sd, point.code, white_code, transfer) / point.sd - 1));
  }
  std::ranges::sort(deviations);
  deviations.resize(deviations.size() - deviations.size() / 4);
  fit.worst = deviations.back();
  for (const double deviation : deviations) fit.misfit += deviation * deviation;
  fit.misfit = std::sqrt(fit.misfit / static_cast<double>(deviations.size()));
  return fit;
}

}  // namespace nutik
