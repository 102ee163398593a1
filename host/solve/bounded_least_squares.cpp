#include "solve/bounded_least_squares.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "system/interruption.hpp"

namespace nutik {
namespace {

using Column = Eigen::Index;

// As a share of a decomposition's largest pivot: smaller pivots are taken for 0.
constexpr double kMinPivot = 1e-9;
// A gradient this much smaller than its parts is none.
constexpr double kMinGradient = 1e-12;

Eigen::MatrixXd factors_of(const std::vector<LeastSquaresRow>& rows) {
  Eigen::MatrixXd factors(static_cast<Column>(rows.size()), static_cast<Column>(rows.front().factors.size()));
  for (Column row = 0; row < factors.rows(); ++row) {
    const std::vector<double>& from = rows[static_cast<std::size_t>(row)].factors;
    for (Column column = 0; column < factors.cols(); ++column)
      factors(row, column) = from[static_cast<std::size_t>(column)];
  }
  return factors;
}

// Bounded-variable least squares after Stark and Parker (1995), from a beginning that need not be the origin.
class ActiveSet {
 public:
  ActiveSet(const std::vector<LeastSquaresRow>& rows, const std::vector<Bounds>& bounds,
            std::vector<double> begin)
      : a_(factors_of(rows)),
        b_(a_.rows()),
        bounds_(bounds),
        x_(Eigen::Map<Eigen::VectorXd>(begin.data(), static_cast<Column>(begin.size()))),
        is_held_(bounds.size(), false) {
    for (Column row = 0; row < b_.size(); ++row) b_[row] = rows[static_cast<std::size_t>(row)].wanted;
  }

  std::vector<double> solve() {
    const auto max_turns = 10 * (bounds_.size() + 1);
    for (std::size_t turn = 0; turn < max_turns; ++turn) {
      check_interruption();
      descend();
      const auto freed = max_wanted_within();
      if (!freed) break;
      is_held_[*freed] = false;
    }
    return {x_.begin(), x_.end()};
  }

 private:
  // To the least squares over all x that no bound holds, holding those whose bounds are in the way.
  void descend() {
    for (;;) {
      std::vector<Column> free;
      for (std::size_t i = 0; i < is_held_.size(); ++i) {
        if (!is_held_[i]) free.push_back(static_cast<Column>(i));
      }
      if (free.empty()) return;
      Eigen::MatrixXd columns(a_.rows(), static_cast<Column>(free.size()));
      for (std::size_t i = 0; i < free.size(); ++i) columns.col(static_cast<Column>(i)) = a_.col(free[i]);
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
      decomposition.setThreshold(kMinPivot);
      decomposition.compute(columns);
      const Eigen::VectorXd step = decomposition.solve(b_ - a_ * x_);
      if (!go(free, step)) return;
    }
  }

  // As far along a step as bounds allow. Returns whether one was met, and holds it then.
  bool go(const std::vector<Column>& free, const Eigen::VectorXd& step) {
    double share = 1.0;
    std::optional<Column> met;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const double by = step[static_cast<Column>(i)];
      const Bounds& bounds = bounds_[static_cast<std::size_t>(free[i])];
      const double room = by < 0 ? bounds.low - x_[free[i]] : bounds.high - x_[free[i]];
      if (by == 0 || std::fabs(by) * share <= std::fabs(room)) continue;
      share = room / by;
      met = free[i];
    }
    for (std::size_t i = 0; i < free.size(); ++i) {
      const auto at = static_cast<std::size_t>(free[i]);
      x_[free[i]] =
          std::clamp(x_[free[i]] + share * step[static_cast<Column>(i)], bounds_[at].low, bounds_[at].high);
    }
    if (!met) return false;
    const auto at = static_cast<std::size_t>(*met);
    x_[*met] = step[std::ranges::find(free, *met) - free.begin()] < 0 ? bounds_[at].low : bounds_[at].high;
    is_held_[at] = true;
    return true;
  }

  // Among the x that bounds hold, the one that would lessen the squares most within them.
  [[nodiscard]] std::optional<std::size_t> max_wanted_within() const {
    const Eigen::VectorXd left = b_ - a_ * x_;
    std::optional<std::size_t> best;
    double most = 0.0;
    for (std::size_t i = 0; i < is_held_.size(); ++i) {
      if (!is_held_[i] || bounds_[i].low == bounds_[i].high) continue;
      const auto column = a_.col(static_cast<Column>(i));
      const double along = column.dot(left);
      const double inward = x_[static_cast<Column>(i)] == bounds_[i].low ? along : -along;
      const double parts = column.norm() * (b_.norm() + left.norm());
      if (inward <= kMinGradient * parts || inward / column.norm() <= most) continue;
      most = inward / column.norm();
      best = i;
    }
    return best;
  }

  Eigen::MatrixXd a_;
  Eigen::VectorXd b_;
  const std::vector<Bounds>& bounds_;
  Eigen::VectorXd x_;
  std::vector<bool> is_held_;  // at a bound
};

}  // namespace

std::vector<double> least_squares(const std::vector<LeastSquaresRow>& rows, const std::vector<Bounds>& bounds,
                                  std::vector<double> begin) {
  if (bounds.empty() || rows.empty()) return begin;
  return ActiveSet(rows, bounds, std::move(begin)).solve();
}

std::size_t rank_of(const std::vector<LeastSquaresRow>& rows) {
  if (rows.empty() || rows.front().factors.empty()) return 0;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kMinPivot);
  decomposition.compute(factors_of(rows));
  return static_cast<std::size_t>(decomposition.rank());
}

}  // namespace nutik
