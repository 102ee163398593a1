// Boundary tables: all that a kernel needs to know of a gain function (docs/explanation/model.md, "Packed tables").
//
//   in:      a gain function, a timeline, and the samples of one block
//   out:     weights      w_k = ∫ g φ_k / D, φ_k being sample k's own hat: 1 while it is exposed, ramps
//                         across the gaps beside it
//            boundaries   B_k = Σ_(first <= j < k) w_j: re-based, 0 at the block's first sample
//   units:   gains are divided by 2^exponent (see GainSummary) and by D, so that |w| <= 2
//   error:   a weight is summed from the closed form of each stretch on which both lines are straight,
//            never as a difference of integrals from the start, so it errs by at most 13 roundings
//            of its own local ∫ ĝ φ / D, ĝ being the line between |g| at the ends of each piece
//            (docs/explanation/accuracy.md). Boundaries add one rounding of their own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/timeline.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

class WeightIntegrator {
 public:
  WeightIntegrator(const GainFunction& function, const GainSummary& summary, std::int64_t duration_ns);

  // Fills weights[i] for the samples with these times, and boundaries with one element more. Blocks may
  // be asked for in any order; in increasing order the whole sweep takes time linear in samples and
  // control points.
  void pack(std::span<const SampleTimes> samples, std::span<double> weights, std::span<double> boundaries);

 private:
  // ∫ g φ of one sample, in nanoseconds of scaled gain.
  double integrate_hat(const SampleTimes& sample);

  std::vector<GainPiece> pieces_;  // scaled
  std::int64_t duration_ns_;
  std::int64_t support_ns_;
  std::size_t piece_ = 0;  // no piece before it meets the reach of the sample asked for last
};

}  // namespace nutik
