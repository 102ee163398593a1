#include "solve/bounded_least_squares.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random_case.hpp"

namespace nutik::test {
namespace {

std::vector<double> residuals(const std::vector<LeastSquaresRow>& rows, const std::vector<double>& x) {
  std::vector<double> left;
  for (const LeastSquaresRow& row : rows) {
    double value = row.wanted;
    for (std::size_t i = 0; i < x.size(); ++i) value -= row.factors[i] * x[i];
    left.push_back(value);
  }
  return left;
}

// What tells a least squares within bounds: no x can go anywhere that lessens the squares (Karush, Kuhn and Tucker).
void expect_least(const std::vector<LeastSquaresRow>& rows, const std::vector<Bounds>& bounds,
                  const std::vector<double>& x, std::uint64_t seed) {
  const std::vector<double> left = residuals(rows, x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_GE(x[i], bounds[i].low) << seed;
    ASSERT_LE(x[i], bounds[i].high) << seed;
    double along = 0;
    for (std::size_t row = 0; row < rows.size(); ++row) along += rows[row].factors[i] * left[row];
    if (x[i] < bounds[i].high) {
      EXPECT_LE(along, 1e-9) << seed << ": x" << i << " could grow";
    }
    if (x[i] > bounds[i].low) {
      EXPECT_GE(along, -1e-9) << seed << ": x" << i << " could shrink";
    }
  }
}

TEST(BoundedLeastSquares, AreLeastWithinBounds) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Random random(seed);
    const auto count = static_cast<std::size_t>(random.whole(1, 7));
    std::vector<LeastSquaresRow> rows(static_cast<std::size_t>(random.whole(1, 9)));
    for (LeastSquaresRow& row : rows) {
      for (std::size_t i = 0; i < count; ++i)
        row.factors.push_back(random.chance(0.2) ? 0.0 : random.real(-2, 2));
      row.wanted = random.real(-3, 3);
    }
    std::vector<Bounds> bounds(count);
    std::vector<double> begin(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (random.chance(0.6)) bounds[i].low = random.real(-1, 0.5);
      if (random.chance(0.6))
        bounds[i].high = std::isfinite(bounds[i].low) ? bounds[i].low + random.real(0, 1) : 0.3;
      begin[i] = std::clamp(0.1, bounds[i].low, bounds[i].high);
    }
    expect_least(rows, bounds, least_squares(rows, bounds, begin), seed);
  }
}

TEST(BoundedLeastSquares, TakeTheNearestWhereThereAreMany) {
  // x + y = 4 from (1, 1): the foot of the perpendicular.
  const std::vector<double> x = least_squares({{{1.0, 1.0}, 4.0}}, {{}, {}}, {1.0, 1.0});
  EXPECT_NEAR(x[0], 2.0, 1e-14);
  EXPECT_NEAR(x[1], 2.0, 1e-14);
  EXPECT_EQ(rank_of({{{1.0, 1.0}, 4.0}, {{2.0, 2.0}, 1.0}}), 1u);
  // The third is in no row.
  EXPECT_EQ(least_squares({{{1.0, 2.0, 0.0}, 4.0}}, {{}, {}, {}}, {0.0, 0.0, 7.0})[2], 7.0);
}

TEST(BoundedLeastSquares, GiveTheOthersWhatABoundKeepsFromOne) {
  const std::vector<double> x = least_squares({{{1.0, 1.0}, 4.0}}, {{0.0, 1.5}, {}}, {1.0, 1.0});
  EXPECT_EQ(x[0], 1.5);
  EXPECT_NEAR(x[1], 2.5, 1e-14);
}

}  // namespace
}  // namespace nutik::test
