// Finds the read and shot noise that points which were measured come from.
#pragma once

#include <cstdint>
#include <span>

#include "capture/noise_model.hpp"

namespace nutik {

// A point, and how sure it is: the share of its standard deviation that it may be off by.
struct MeasuredPoint {
  NoisePoint point;
  double uncertainty = 0;
};

struct SensorFit {
  double read = 0;  // as in ChannelNoise
  double shot = 0;
  // By which share sd differs between the points and the fit: root of the mean square, and the largest, of the
  // three quarters of the points that lie closest. Others may be of something else than noise.
  double misfit = 0;
  double worst = 0;
};

// Weighted least squares of variance in light over light, neither noise below 0, with little say for points
// far off the line. At least one point.
[[nodiscard]] SensorFit fit_sensor(std::span<const MeasuredPoint> points, std::uint32_t white_code,
                                   const Transfer& transfer);

}  // namespace nutik
