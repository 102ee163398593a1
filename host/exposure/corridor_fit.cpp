#include "exposure/corridor_fit.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace nutik {
namespace {

// Where a corner may lie, in tolerances from the curve.
constexpr std::array<double, 5> kOffsets{-1.0, -0.5, 0.0, 0.5, 1.0};
constexpr std::size_t kOnCurve = 2;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
// Halvings of the tolerance's range once the number of corners is known: 1/128 of it.
constexpr int kHalvings = 7;

class Search {
 public:
  Search(std::span<const ControlPoint> samples, double tolerance, double low, double high)
      : samples_(samples),
        tolerance_(tolerance),
        low_(low),
        high_(high),
        previous_(samples.size() * kOffsets.size(), kNone) {}

  // The corners, by increasing time.
  std::vector<ControlPoint> run() {
    const std::size_t goal = (samples_.size() - 1) * kOffsets.size() + kOnCurve;
    std::vector<std::size_t> layer{kOnCurve}, next;
    previous_[kOnCurve] = kOnCurve;
    while (previous_[goal] == kNone) {
      if (layer.empty()) throw std::logic_error("a corridor has no way through");
      next.clear();
      for (const std::size_t corner : layer) see_from(corner, next);
      layer.swap(next);
    }
    std::vector<ControlPoint> corners;
    for (std::size_t corner = goal;; corner = previous_[corner]) {
      corners.push_back({samples_[corner / kOffsets.size()].time_ns, gain_of(corner)});
      if (corner == kOnCurve) break;
    }
    std::reverse(corners.begin(), corners.end());
    return corners;
  }

 private:
  [[nodiscard]] double gain_of(std::size_t corner) const {
    const double curve = samples_[corner / kOffsets.size()].gain;
    return std::clamp(curve + kOffsets[corner % kOffsets.size()] * tolerance_, low_, high_);
  }

  [[nodiscard]] bool may_stand(std::size_t corner) const {
    const std::size_t sample = corner / kOffsets.size();
    if (corner % kOffsets.size() == kOnCurve) return true;
    if (sample == 0 || sample + 1 == samples_.size()) return false;
    const double curve = samples_[sample].gain;
    return gain_of(corner) * curve > 0.0;
  }

  // Adds every corner that a straight piece reaches from this one and that was not reached before.
  void see_from(std::size_t from, std::vector<std::size_t>& next) {
    const double gain = gain_of(from);
    const std::size_t first = from / kOffsets.size();
    double least = -std::numeric_limits<double>::infinity(), most = -least;  // slopes that stay inside so far
    for (std::size_t sample = first + 1; sample < samples_.size() && least <= most; ++sample) {
      const auto length = static_cast<double>(samples_[sample].time_ns - samples_[first].time_ns);
      const double curve = samples_[sample].gain;
      least = std::max(least, (std::max(curve - tolerance_, low_) - gain) / length);
      most = std::min(most, (std::min(curve + tolerance_, high_) - gain) / length);
      for (std::size_t offset = 0; offset < kOffsets.size(); ++offset) {
        const std::size_t corner = sample * kOffsets.size() + offset;
        if (previous_[corner] != kNone || !may_stand(corner)) continue;
        const double slope = (gain_of(corner) - gain) / length;
        if (slope < least || slope > most) continue;
        previous_[corner] = from;
        next.push_back(corner);
      }
    }
  }

  std::span<const ControlPoint> samples_;
  double tolerance_;
  double low_;
  double high_;
  std::vector<std::size_t> previous_;  // by corner: sample × offset; kNone where it was not reached
};

}  // namespace

std::vector<ControlPoint> fit_corridor(std::span<const ControlPoint> samples, double tolerance, double low,
                                       double high) {
  std::vector<ControlPoint> best = Search(samples, tolerance, low, high).run();
  double enough = tolerance, too_little = 0.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (enough + too_little) / 2;
    std::vector<ControlPoint> fit = Search(samples, middle, low, high).run();
    if (fit.size() > best.size()) {
      too_little = middle;
    } else {
      best = std::move(fit);
      enough = middle;
    }
  }
  return best;
}

}  // namespace nutik
