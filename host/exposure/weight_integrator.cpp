#include "exposure/weight_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "exposure/compensated_sum.hpp"

namespace nutik {
namespace {

// A straight stretch of a sample's hat.
struct HatPart {
  std::int64_t begin_ns;
  std::int64_t end_ns;
  double begin;
  double end;

  [[nodiscard]] double at(std::int64_t time_ns) const {
    if (begin == end) return begin;
    const auto length = static_cast<double>(end_ns - begin_ns);
    return begin * (static_cast<double>(end_ns - time_ns) / length) +
           end * (static_cast<double>(time_ns - begin_ns) / length);
  }
};

// ∫ of the product of two straight lines over a stretch of `length`, from their values at its ends.
double integrate_product(double length, double f0, double f1, double g0, double g1) {
  return length / 6.0 * (f0 * (2.0 * g0 + g1) + f1 * (g0 + 2.0 * g1));
}

}  // namespace

WeightIntegrator::WeightIntegrator(const GainFunction& function, const GainSummary& summary, std::int64_t duration_ns)
    : pieces_(function.pieces(duration_ns)), duration_ns_(duration_ns), support_ns_(summary.support_ns) {
  for (GainPiece& piece : pieces_) {
    piece.begin_gain = std::scalbn(piece.begin_gain, -summary.exponent);
    piece.end_gain = std::scalbn(piece.end_gain, -summary.exponent);
  }
}

double WeightIntegrator::integrate_hat(const SampleTimes& sample) {
  // The last sample's light holds until the end of the capture; every other one's ramps away.
  const double after = sample.after_ns == duration_ns_ ? 1.0 : 0.0;
  const HatPart parts[3] = {{sample.before_ns, sample.start_ns, 0.0, 1.0},
                            {sample.start_ns, sample.end_ns, 1.0, 1.0},
                            {sample.end_ns, sample.after_ns, 1.0, after}};

  while (piece_ > 0 && pieces_[piece_].begin_ns > sample.before_ns) --piece_;
  while (piece_ + 1 < pieces_.size() && pieces_[piece_].end_ns <= sample.before_ns) ++piece_;
  CompensatedSum sum;
  for (std::size_t i = piece_; i < pieces_.size() && pieces_[i].begin_ns < sample.after_ns; ++i) {
    const GainPiece& piece = pieces_[i];
    if (piece.is_zero()) continue;
    for (const HatPart& part : parts) {
      const std::int64_t from = std::max(piece.begin_ns, part.begin_ns);
      const std::int64_t to = std::min(piece.end_ns, part.end_ns);
      if (from >= to) continue;
      sum.add(integrate_product(static_cast<double>(to - from), piece.at(from), piece.at(to), part.at(from),
                                part.at(to)));
    }
  }
  return sum.value();
}

void WeightIntegrator::pack(std::span<const SampleTimes> samples, std::span<double> weights,
                       std::span<double> boundaries) {
  const auto support = static_cast<double>(support_ns_);
  CompensatedSum boundary;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    weights[i] = support_ns_ == 0 ? 0.0 : integrate_hat(samples[i]) / support;
    boundaries[i] = boundary.value();
    boundary.add(weights[i]);
  }
  boundaries[samples.size()] = boundary.value();
}

}  // namespace nutik
