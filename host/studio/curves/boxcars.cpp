#include "studio/curves/boxcars.hpp"

namespace nutik::studio {
namespace {

bool is_step(const Points& points, std::size_t first) {
  return points[first + 1].time_ns - points[first].time_ns == 1 &&
         points[first + 1].gain != points[first].gain;
}

}  // namespace

std::vector<GainBoxcar> boxcars_of(const Points& points) {
  std::vector<GainBoxcar> boxcars;
  for (std::size_t i = 0; i + 2 < points.size(); ++i) {
    const ControlPoint &begin = points[i], &end = points[i + 1];
    if (begin.gain != end.gain || begin.gain == 0.0 || !is_step(points, i + 1)) continue;
    const bool has_first_step = i > 0 && is_step(points, i - 1);
    if (!has_first_step && (i > 0 || begin.time_ns > 0)) continue;
    boxcars.push_back({i, i + 1, begin.time_ns, end.time_ns, begin.gain, has_first_step});
  }
  return boxcars;
}

Points with_boxcar_moved(const Points& points, const GainBoxcar& boxcar, BoxcarPart part,
                         std::int64_t by_ns) {
  Points result = points;
  std::size_t first = boxcar.first, last = boxcar.last;
  if (!boxcar.has_first_step && part != BoxcarPart::end) {
    result.insert(result.begin(), {boxcar.begin_ns - 1, 0.0});
    ++first;
    ++last;
  }
  if (part == BoxcarPart::begin) return moved(result, {first}, {by_ns, 0.0});
  if (part == BoxcarPart::end) return moved(result, {last}, {by_ns, 0.0});
  return moved(result, {first, last}, {by_ns, 0.0});
}

}  // namespace nutik::studio
