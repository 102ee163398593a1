// Least squares with bounds.
//
//   in:      rows a · x = b, bounds of each x, and an x to begin with
//   out:     the x within the bounds with the least Σ (a · x − b)²; among several the one that the shortest steps from
//            the beginning lead to: the nearest one, if no bound is in the way
//   always:  an active set on an orthogonal decomposition of the rows, never of their squares: about as many digits are
//            lost as the rows' condition number has
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace nutik {

struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

struct LeastSquaresRow {
  std::vector<double> factors;  // one for each x
  double wanted = 0.0;
};

// `begin` has as many numbers as `bounds`, and lies within them.
[[nodiscard]] std::vector<double> least_squares(const std::vector<LeastSquaresRow>& rows,
                                                const std::vector<Bounds>& bounds, std::vector<double> begin);

// How many x the rows determine: any others keep what the beginning says.
[[nodiscard]] std::size_t rank_of(const std::vector<LeastSquaresRow>& rows);

}  // namespace nutik
