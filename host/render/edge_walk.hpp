// The integral of light times gain over one straight stretch of a pixel's light, edge by edge.
// Used by the reference alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "exposure/compensated_sum.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

// Light that runs straight from `begin` to `end`.
struct LightStretch {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] double at(std::int64_t time_ns) const {
    if (begin == end) return begin;
    return begin +
           (end - begin) * (static_cast<double>(time_ns - begin_ns) / static_cast<double>(end_ns - begin_ns));
  }
};

// A gain function as the reference walks along it.
class GainWalk {
 public:
  // Gains are divided by 2^exponent() so that the sums neither overflow nor lose digits; the caller
  // multiplies the result by it.
  // `support_ns` is D, if it is not that of the pieces.
  explicit GainWalk(std::vector<GainPiece> pieces, std::optional<std::int64_t> support_ns = {})
      : pieces_(std::move(pieces)) {
    double largest = 0.0;
    for (const GainPiece& piece : pieces_) {
      if (piece.begin_gain == 0.0 && piece.end_gain == 0.0) continue;
      support_ns_ += piece.end_ns - piece.begin_ns;
      largest = std::max({largest, std::fabs(piece.begin_gain), std::fabs(piece.end_gain)});
    }
    if (support_ns) support_ns_ = *support_ns;
    exponent_ = largest > 0.0 ? std::ilogb(largest) : 0;
    for (GainPiece& piece : pieces_) {
      piece.begin_gain = std::scalbn(piece.begin_gain, -exponent_);
      piece.end_gain = std::scalbn(piece.end_gain, -exponent_);
    }
  }

  [[nodiscard]] int exponent() const { return exponent_; }
  [[nodiscard]] std::int64_t support_ns() const { return support_ns_; }  // D

  // The piece that holds `time_ns`, as a place to start a walk from.
  [[nodiscard]] std::size_t piece_at(std::int64_t time_ns) const {
    std::size_t piece = 0;
    while (piece + 1 < pieces_.size() && pieces_[piece].end_ns <= time_ns) ++piece;
    return piece;
  }

  // Calls visit(begin_ns, end_ns, gain at begin, gain at end) for every interval of [begin_ns, end_ns]
  // between two control points. `piece` is the walk's place and moves on with it.
  template <typename Visit>
  void for_each_interval(std::int64_t begin_ns, std::int64_t end_ns, std::size_t& piece, Visit visit) const {
    std::int64_t time_ns = begin_ns;
    while (time_ns < end_ns) {
      while (pieces_[piece].end_ns <= time_ns) ++piece;
      const std::int64_t until_ns = std::min(pieces_[piece].end_ns, end_ns);
      visit(time_ns, until_ns, gain_at(pieces_[piece], time_ns), gain_at(pieces_[piece], until_ns));
      time_ns = until_ns;
    }
  }

 private:
  [[nodiscard]] static double gain_at(const GainPiece& piece, std::int64_t time_ns) {
    if (time_ns == piece.end_ns) return piece.end_gain;
    return piece.begin_gain +
           (piece.end_gain - piece.begin_gain) * (static_cast<double>(time_ns - piece.begin_ns) /
                                                  static_cast<double>(piece.end_ns - piece.begin_ns));
  }

  std::vector<GainPiece> pieces_;
  int exponent_ = 0;
  std::int64_t support_ns_ = 0;
};

// ∫ light × gain over the interval, both straight on it: mean times mean, plus a twelfth of the product
// of their rises, times the length.
inline double integrate_interval(double length_ns, double light0, double light1, double gain0, double gain1) {
  const double means = (light0 + light1) * (gain0 + gain1) / 4.0;
  const double rises = (light1 - light0) * (gain1 - gain0) / 12.0;
  return length_ns * (means + rises);
}

}  // namespace nutik
