#include "studio/curves/snapping.hpp"

#include <algorithm>
#include <cmath>

#include "session/requests/stated_time.hpp"
#include "studio/time/sample_times.hpp"

namespace nutik::studio {
namespace {

// Of a function of more points the first ones are snapped to: nobody aligns with one of a million by eye.
constexpr std::size_t kMaxPoints = 10'000;

bool is_earlier(const TimeSnap& a, const TimeSnap& b) { return a.time_ns < b.time_ns; }

QString sample_text(std::int64_t time_ns, const Timeline& timeline) {
  if (time_ns >= timeline.duration_ns()) return "end of the capture";
  const std::uint64_t sample = sample_at(time_ns, timeline);
  if (timeline.start_ns(sample) == time_ns) return QString("start of sample %1").arg(sample);
  return QString("end of sample %1").arg(sample);
}

}  // namespace

Snapper::Snapper(const Timeline* timeline, const FunctionSet& functions, std::uint8_t moved_tag)
    : timeline_(timeline), gains_{{0.0, "gain 0"}, {1.0, "gain 1"}} {
  if (timeline != nullptr) {
    times_ = {{0, "start of the capture"}, {timeline->duration_ns(), "end of the capture"}};
  }
  for (const auto& [tag, function] : functions) {
    if (tag == moved_tag) continue;
    const QString what = QString("point of M%1").arg(tag);
    const auto points = function.points();
    for (const ControlPoint& point : points.first(std::min(points.size(), kMaxPoints))) {
      times_.push_back({point.time_ns, what});
      gains_.push_back({point.gain, what});
    }
  }
  std::stable_sort(times_.begin(), times_.end(), is_earlier);
}

void Snapper::add_time(std::int64_t time_ns, const QString& what) {
  const TimeSnap added{time_ns, what};
  times_.insert(std::upper_bound(times_.begin(), times_.end(), added, is_earlier), added);
}

void Snapper::add_gain(double gain, const QString& what) { gains_.push_back({gain, what}); }

std::optional<TimeSnap> Snapper::time(std::int64_t time_ns, double reach_ns) const {
  const auto distance = [&](std::int64_t at) { return std::fabs(static_cast<double>(at - time_ns)); };
  const auto after = std::lower_bound(times_.begin(), times_.end(), TimeSnap{time_ns, {}}, is_earlier);
  std::optional<TimeSnap> nearest;
  if (after != times_.end()) nearest = *after;
  if (after != times_.begin() && (!nearest || distance((after - 1)->time_ns) < distance(nearest->time_ns)))
    nearest = *(after - 1);
  if (nearest && distance(nearest->time_ns) <= reach_ns) return nearest;
  if (timeline_ == nullptr) return std::nullopt;
  const std::int64_t edge = nearest_sample_edge(time_ns, *timeline_);
  if (distance(edge) > reach_ns) return std::nullopt;
  return TimeSnap{edge, sample_text(edge, *timeline_)};
}

std::optional<GainSnap> Snapper::gain(double gain, double reach) const {
  std::optional<GainSnap> nearest;
  for (const GainSnap& candidate : gains_) {
    const double distance = std::fabs(candidate.gain - gain);
    if (distance <= reach && (!nearest || distance < std::fabs(nearest->gain - gain))) nearest = candidate;
  }
  return nearest;
}

}  // namespace nutik::studio
