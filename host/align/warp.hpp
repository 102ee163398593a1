// Where a place of one picture is in another: a projective map of the plane.
//
// Places are counted in pixels from the middle of the top left one: the middle of the bottom right one is
// (width - 1, height - 1).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace nutik {

struct Place {
  double x = 0;
  double y = 0;
};

struct Warp {
  // Row by row: (x, y) goes to (m0 x + m1 y + m2, m3 x + m4 y + m5) / (m6 x + m7 y + m8).
  std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};

  [[nodiscard]] Place at(double x, double y) const {
    const double z = m[6] * x + m[7] * y + m[8];
    return {(m[0] * x + m[1] * y + m[2]) / z, (m[3] * x + m[4] * y + m[5]) / z};
  }

  // By how many degrees it turns what lies round a place, clockwise as pictures are seen.
  [[nodiscard]] double degrees_at(double x, double y) const {
    constexpr double kDegrees = 57.295779513082321;
    const auto [px, py] = at(x, y);
    const double a = m[0] - m[6] * px, b = m[1] - m[7] * px, c = m[3] - m[6] * py, d = m[4] - m[7] * py;
    return kDegrees * std::atan2(c - b, a + d);
  }

  friend bool operator==(const Warp&, const Warp&) = default;
};

// First `first`, then `second`.
[[nodiscard]] inline Warp chained(const Warp& first, const Warp& second) {
  Warp product;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += second.m[3 * row + k] * first.m[3 * k + column];
      product.m[3 * row + column] = sum;
    }
  }
  const double scale = product.m[8];
  for (double& entry : product.m) entry /= scale;
  return product;
}

// The way back, of a warp that is not flat.
[[nodiscard]] inline Warp inverse(const Warp& warp) {
  const auto& m = warp.m;
  Warp back;
  back.m = {m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
            m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
            m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
  const double scale = back.m[8];
  for (double& entry : back.m) entry /= scale;
  return back;
}

}  // namespace nutik
