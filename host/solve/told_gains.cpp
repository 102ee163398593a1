// Which gains wishes tell.
#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "solve/gain_search.hpp"

namespace nutik {
namespace {

using Kind = LightWish::Kind;

// Light that changes by less than this share of what would be there without other gains does not change.
constexpr double kNoChange = 1e-9;

}  // namespace

std::vector<LeastSquaresRow> GainSearch::changes_of_found() const {
  try {
    return changes(gains_);
  } catch (const InputError&) {  // a function whose parts cancel right beside it
    return {};
  }
}

std::vector<std::size_t> GainSearch::untold() const {
  const std::vector<LeastSquaresRow> rows = changes_of_found();
  std::vector<std::size_t> untold;
  if (rows.empty()) return untold;
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    if (std::ranges::all_of(rows, [&](const LeastSquaresRow& row) { return row.factors[i] == 0.0; }))
      untold.push_back(i);
  }
  return untold;
}

std::size_t GainSearch::open_count() const {
  const std::vector<std::size_t> untold = this->untold();
  std::vector<std::size_t> told;  // within their bounds
  for (std::size_t i = 0; i < gains_.size(); ++i) {
    if (gains_[i] > bounds_[i].low && gains_[i] < bounds_[i].high && std::ranges::count(untold, i) == 0)
      told.push_back(i);
  }
  std::vector<LeastSquaresRow> rows;
  for (const LeastSquaresRow& all : changes_of_found()) {
    const Kind kind = row_kinds_[rows.size()];
    LeastSquaresRow kept;
    // A wish that is kept with something left tells nothing.
    const bool is_kept = (kind == Kind::at_most && all.wanted < -kNoChange) ||
                         (kind == Kind::at_least && all.wanted > kNoChange);
    for (const std::size_t i : told) kept.factors.push_back(is_kept ? 0.0 : all.factors[i]);
    rows.push_back(std::move(kept));
  }
  if (rows.empty()) return 0;
  // Where all gains of a function are found, and a divisor grows with them, that they all be larger is no other answer.
  std::size_t scales = 0;
  for (const auto& [tag, parts] : parts_) {
    std::vector<double> direction;
    for (const std::size_t i : told) {
      const bool is_of_it =
          std::ranges::any_of(parts.points, [&](const TemplatePoint& point) { return point.gain_name == i; });
      direction.push_back(is_of_it ? gains_[i] : 0.0);
    }
    double change = 0.0, all = 0.0;
    for (const LeastSquaresRow& row : rows) {
      double sum = 0.0;
      for (std::size_t i = 0; i < told.size(); ++i) {
        sum += row.factors[i] * direction[i];
        all += std::fabs(row.factors[i] * direction[i]);
      }
      change += std::fabs(sum);
    }
    scales += all > 0.0 && change <= kNoChange * all ? 1u : 0u;
  }
  const std::size_t known = rank_of(rows) + scales;
  return told.size() - std::min(told.size(), known);
}

}  // namespace nutik
