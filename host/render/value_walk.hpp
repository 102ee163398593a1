// The walk along one value (a channel of a pixel) in time order, edge by edge: what the reference sums, and
// what a trace shows.
//
// An edge is a change of the light (a record) or of the gain's slope (a control point). Between two edges
// both run straight, and the exact integral of their product is added.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "exposure/compensated_sum.hpp"
#include "exposure/gain_function.hpp"
#include "exposure/mixed_pixels.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// The integral of light times gain over one straight stretch of a pixel's light, edge by edge.
// Used by the reference alone.

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

// The light that a code of a capture stands for.
[[nodiscard]] inline double light_of_code(const CaptureFormat& capture, std::uint32_t code) {
  return capture.transfer.light_of(static_cast<double>(code) / capture.white_code);
}

// Where a walk has come to.
struct ValueWalk {
  CompensatedSum sum;  // ∫ light × scaled gain
  double light = 0.0;  // at the end of the block before
};

// From one edge to the next. Gains are scaled as GainWalk has them.
struct WalkStep {
  std::int64_t begin_ns;
  std::int64_t end_ns;
  double begin_light;
  double end_light;
  double begin_gain;
  double end_gain;
  double integral;  // what it adds to the sum
};

// A block: when its samples were exposed, and whether the walk comes from the block before it.
struct WalkedBlock {
  std::span<const SampleTimes> times;
  bool follows_the_one_before;
  bool ends_capture;
};

// Walks through a block: the gap before its first sample, then each record: a ramp across the gap before
// it, then its constant light until the next record's gap, the block's end or the capture's end. There are
// `records` of them; sample_of(r) is the number in the block of the sample at which record r starts, 0 for
// the first, light_of(r) its light. `piece` is gain.piece_at() of the block's first reach. Calls visit(step)
// after each step has been added.
template <typename SampleOf, typename LightOf, typename Visit>
void walk_block(ValueWalk& walk, const GainWalk& gain, std::size_t piece, const WalkedBlock& block,
                std::size_t records, SampleOf sample_of, LightOf light_of, Visit visit) {
  const auto expose = [&](const LightStretch& light) {
    gain.for_each_interval(
        light.begin_ns, light.end_ns, piece,
        [&](std::int64_t begin_ns, std::int64_t end_ns, double gain0, double gain1) {
          WalkStep step{begin_ns, end_ns, light.at(begin_ns), light.at(end_ns), gain0, gain1, 0.0};
          step.integral = integrate_interval(static_cast<double>(end_ns - begin_ns), step.begin_light,
                                             step.end_light, gain0, gain1);
          walk.sum.add(step.integral);
          visit(step);
        });
  };
  for (std::size_t r = 0; r < records; ++r) {
    const double light = light_of(r);
    const SampleTimes& from = block.times[sample_of(r)];
    const bool has_before = r > 0 || block.follows_the_one_before;
    expose({from.before_ns, from.start_ns, has_before ? walk.light : light, light});
    const bool is_last = r + 1 == records;
    const SampleTimes& until = is_last ? block.times.back() : block.times[sample_of(r + 1) - 1];
    expose({from.start_ns, is_last && block.ends_capture ? until.after_ns : until.end_ns, light, light});
    walk.light = light;
  }
}

// Along the function of a plan, over the capture's domain. A delayed one is moved there; its D is how long it differs
// from 0 over its whole course, between its control points and in the capture.
[[nodiscard]] inline GainWalk walk_along(const PlannedFunction& planned, std::int64_t duration_ns) {
  if (!planned.is_delayed) return GainWalk(planned.function.pieces(duration_ns));
  const std::span<const ControlPoint> points = planned.function.points();
  const std::int64_t begin_ns = std::min<std::int64_t>(0, points.front().time_ns);
  const std::int64_t end_ns = std::max(duration_ns, points.back().time_ns);
  const GainWalk course(planned.function.shifted(-begin_ns).pieces(end_ns - begin_ns));
  // A held end counts in the capture alone, not on the way from there to a control point beyond.
  std::int64_t held_outside_ns = 0;
  if (points.front().gain != 0.0) held_outside_ns += std::max<std::int64_t>(0, points.front().time_ns - duration_ns);
  if (points.back().gain != 0.0) held_outside_ns += std::max<std::int64_t>(0, -points.back().time_ns);
  return GainWalk(planned.function.shifted(planned.delay_ns).pieces(duration_ns),
                  course.support_ns() - held_outside_ns);
}

// What a walk to the end comes to: the light of the exposure, ∫ light × gain / D.
[[nodiscard]] inline double exposed_light(const CompensatedSum& sum, const GainWalk& gain) {
  if (gain.support_ns() == 0) return 0.0;
  return std::scalbn(sum.value() / static_cast<double>(gain.support_ns()), gain.exponent());
}

// The light of a mixed pixel: Σ share · light. light_of(i) is that of the i-th share's function.
template <typename LightOf>
[[nodiscard]] double mixed_light(std::span<const Share> shares, LightOf light_of) {
  CompensatedSum sum;
  for (std::size_t i = 0; i < shares.size(); ++i) sum.add(shares[i].size * light_of(i));
  return sum.value() / kWholeShare;
}

}  // namespace nutik
