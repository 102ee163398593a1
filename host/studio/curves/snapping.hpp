// Times and gains that a drag is drawn to.
//
//   in:      where the hand is, and how far (in ns and in gain) a target may be
//   out:     the target, and what it is, to be said; none if nothing is near
//   always:  a point of a function, a mark or an end of the capture comes before samples, which may lie too densely to
//            leave anything else a chance
#pragma once

#include <QString>
#include <cstdint>
#include <optional>
#include <vector>

#include "studio/curves/points.hpp"

namespace nutik::studio {

struct TimeSnap {
  std::int64_t time_ns = 0;
  QString what;  // `M128's point`, `start of sample 37`
};
struct GainSnap {
  double gain = 0.0;
  QString what;
};

class Snapper {
 public:
  // What of a capture and other functions there is to snap to. The timeline outlives the snapper.
  Snapper(const Timeline* timeline, const FunctionSet& functions, std::uint8_t moved_tag);

  // More of both: where a drag began, marks.
  void add_time(std::int64_t time_ns, const QString& what);
  void add_gain(double gain, const QString& what);

  [[nodiscard]] std::optional<TimeSnap> time(std::int64_t time_ns, double reach_ns) const;
  [[nodiscard]] std::optional<GainSnap> gain(double gain, double reach) const;

 private:
  const Timeline* timeline_;
  std::vector<TimeSnap> times_;  // increasing
  std::vector<GainSnap> gains_;
};

}  // namespace nutik::studio
