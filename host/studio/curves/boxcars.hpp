// The boxcars of a function: stretches of one gain between two steps, which are moved as one.
//
//   in:      control points with increasing times
//   out:     boxcars in time order; the points with one of them changed
//   always:  a boxcar that begins with the capture may lack its first step: [0:1], [10000000:1], [10000001:0]. It gets
//            one, [-1:0], as soon as its begin is moved
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "studio/curves/points.hpp"

namespace nutik::studio {

struct GainBoxcar {
  std::size_t first = 0, last = 0;  // points of its constant gain
  std::int64_t begin_ns = 0, end_ns = 0;
  double gain = 0.0;
  bool has_first_step = true;

  friend bool operator==(const GainBoxcar&, const GainBoxcar&) = default;
};

[[nodiscard]] std::vector<GainBoxcar> boxcars_of(const Points& points);

enum class BoxcarPart { whole, begin, end, gain };

// Its ends, or one of them, so much later; its gain stays. It stays as long as a nanosecond.
[[nodiscard]] Points with_boxcar_moved(const Points& points, const GainBoxcar& boxcar, BoxcarPart part,
                                       std::int64_t by_ns);

}  // namespace nutik::studio
