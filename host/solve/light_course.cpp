#include "solve/light_course.hpp"

#include <algorithm>
#include <utility>

namespace nutik {
namespace {

constexpr std::size_t kRun = 64;

}  // namespace

LightCourse::LightCourse(const Timeline& timeline, std::uint64_t first, std::vector<ChannelLight> light)
    : light_(std::move(light)) {
  edges_ns_.reserve(2 * light_.size() + 1);
  for (std::uint64_t k = 0; k < light_.size(); ++k) {
    edges_ns_.push_back(timeline.start_ns(first + k));
    edges_ns_.push_back(timeline.end_ns(first + k));
  }
  edges_ns_.push_back(timeline.reach_end_ns(first + light_.size() - 1));
  const std::size_t stretches = edges_ns_.size() - 1;
  runs_.reserve(stretches / kRun);
  for (std::size_t begin = 0; begin + kRun <= stretches; begin += kRun) {
    Run run{edges_ns_[begin], edges_ns_[begin + kRun]};
    std::array<CompensatedSum, 3> sums, moments;
    const auto half = static_cast<double>(run.end_ns - run.begin_ns) / 2;
    for (std::size_t i = begin; i < begin + kRun; ++i) {
      add_stretch(i, {run.begin_ns, run.end_ns, 1.0, 1.0}, sums);
      add_stretch(i, {run.begin_ns, run.end_ns, -half, half}, moments);
    }
    for (std::size_t channel = 0; channel < 3; ++channel) {
      run.light_ns[channel] = sums[channel].value();
      run.moment_ns2[channel] = moments[channel].value();
    }
    runs_.push_back(run);
  }
}

std::uint64_t LightCourse::bytes(std::uint64_t samples) {
  return samples * (sizeof(ChannelLight) + 2 * sizeof(std::int64_t)) + 2 * samples / kRun * sizeof(Run);
}

std::size_t LightCourse::stretch_at(std::int64_t time_ns) const {
  const auto behind = std::ranges::upper_bound(edges_ns_, time_ns);
  const auto at = behind - edges_ns_.begin() - 1;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, std::ssize(edges_ns_) - 2));
}

// What of a piece lies in a stretch.
void LightCourse::add_stretch(std::size_t stretch, const GainPiece& piece,
                              std::array<CompensatedSum, 3>& sums) const {
  const std::int64_t begin_ns = std::max(edges_ns_[stretch], piece.begin_ns);
  const std::int64_t end_ns = std::min(edges_ns_[stretch + 1], piece.end_ns);
  if (begin_ns >= end_ns) return;
  const ChannelLight& from = light_[stretch / 2];
  const bool is_ramp = stretch % 2 == 1 && stretch / 2 + 1 < light_.size();
  const ChannelLight& to = is_ramp ? light_[stretch / 2 + 1] : from;
  const auto length = static_cast<double>(edges_ns_[stretch + 1] - edges_ns_[stretch]);
  const double begin_share = static_cast<double>(begin_ns - edges_ns_[stretch]) / length;
  const double end_share = static_cast<double>(end_ns - edges_ns_[stretch]) / length;
  const double begin_gain = piece.at(begin_ns), end_gain = piece.at(end_ns);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double rise = to[channel] - from[channel];
    const double begin = from[channel] + rise * begin_share, end = from[channel] + rise * end_share;
    // Simpson's rule, which is exact for the product of two straight lines.
    const double middle = (begin + end) * (begin_gain + end_gain);
    sums[channel].add(static_cast<double>(end_ns - begin_ns) *
                      (begin * begin_gain + middle + end * end_gain) / 6);
  }
}

ChannelLight LightCourse::integral_ns(std::span<const GainPiece> pieces) const {
  std::array<CompensatedSum, 3> sums;
  for (const GainPiece& piece : pieces) {
    if (piece.is_zero()) continue;
    const std::size_t last = stretch_at(piece.end_ns - 1);
    for (std::size_t i = stretch_at(piece.begin_ns); i <= last; ++i) {
      const std::size_t run = i / kRun;
      const bool is_whole = i % kRun == 0 && run < runs_.size() && runs_[run].begin_ns >= piece.begin_ns &&
                            runs_[run].end_ns <= piece.end_ns;
      if (!is_whole) {
        add_stretch(i, piece, sums);
        continue;
      }
      const auto length = static_cast<double>(piece.end_ns - piece.begin_ns);
      const auto span_ns = static_cast<double>(runs_[run].end_ns - runs_[run].begin_ns);
      const double begin_gain = piece.at(runs_[run].begin_ns),
                   slope = (piece.end_gain - piece.begin_gain) / length;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        sums[channel].add((begin_gain + slope * span_ns / 2) * runs_[run].light_ns[channel]);
        sums[channel].add(slope * runs_[run].moment_ns2[channel]);
      }
      i += kRun - 1;
    }
  }
  return {sums[0].value(), sums[1].value(), sums[2].value()};
}

}  // namespace nutik
