// A smooth curve through points that never leaves the range between neighbours: the monotone cubic
// interpolation of Fritsch and Butland (1984). Where a point is higher or lower than both neighbours the curve
// turns there; between points that are alike it is flat.
#pragma once

#include <array>
#include <vector>

namespace nutik {

class MonotoneSpline {
 public:
  struct Knot {
    double at = 0.0;
    double value = 0.0;
    friend bool operator==(const Knot&, const Knot&) = default;
  };

  // Two knots or more, `at` strictly increasing.
  explicit MonotoneSpline(std::vector<Knot> knots);

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }
  // For `at` between the first and the last knot.
  [[nodiscard]] double operator()(double at) const;
  // The largest |second derivative| between knots i and i + 1: a cubic has it at one of them.
  [[nodiscard]] double largest_bend(std::size_t i) const;

 private:
  std::vector<Knot> knots_;
  std::vector<double> slopes_;  // at the knots
};

}  // namespace nutik
