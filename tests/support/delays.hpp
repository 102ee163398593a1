// Time maps, given and random.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "exposure/delay_map.hpp"
#include "support/random_case.hpp"

namespace nutik::test {

inline PlanOptions delayed_by(DelayMap map) { return {.delays = std::make_shared<const DelayMap>(std::move(map))}; }

// Rows, columns, circles, or a picture pixel by pixel, of few values or of many; to either side by up to the capture's
// length or a little, so that functions leave the capture wholly, in part, or not at all.
inline std::shared_ptr<const DelayMap> random_delays(Random& random, const Shape& shape,
                                                     std::int64_t duration_ns) {
  const std::int64_t max_ns = std::max<std::int64_t>(1, random.chance(0.3) ? duration_ns : duration_ns / 10);
  const DelayRange range{random.whole(-max_ns, max_ns), random.whole(-max_ns, max_ns)};
  switch (random.whole(0, 4)) {
    case 0: return std::make_shared<const DelayMap>(DelayMap::by_rows(shape, range));
    case 1: return std::make_shared<const DelayMap>(DelayMap::by_columns(shape, range));
    case 2: return std::make_shared<const DelayMap>(DelayMap::by_radius(shape, range));
    default: break;
  }
  Picture picture({shape.width, shape.height, 1}, ValueType::code16, 65'535);
  const std::int64_t values = random.pick(std::vector<std::int64_t>{1, 2, 300, 65'536});
  for (std::uint16_t& code : picture.values<std::uint16_t>()) {
    code = static_cast<std::uint16_t>(random.whole(0, values - 1) * (65'535 / values));
  }
  return std::make_shared<const DelayMap>(DelayMap::by_picture(picture, range, "a random map"));
}

// Functions get points outside the capture, at one end, at both, or all of them, and hold their gains from there on.
// Held gains count in the capture alone.
inline void hold_ends(Random& random, FunctionSet& functions, std::int64_t duration_ns) {
  const auto beyond = [&] { return random.whole(1, std::max<std::int64_t>(1, duration_ns)); };
  const std::int64_t ends = random.whole(1, 5);
  for (auto& [tag, function] : functions) {
    std::vector<ControlPoint> points(function.points().begin(), function.points().end());
    const std::int64_t early_ns = std::min<std::int64_t>(0, points.front().time_ns) - beyond();
    const std::int64_t late_ns = std::max(duration_ns, points.back().time_ns) + beyond();
    if (ends == 4 || ends == 5) {
      const std::int64_t move_ns = ends == 4 ? early_ns - points.back().time_ns : late_ns - points.front().time_ns;
      for (ControlPoint& point : points) point.time_ns += move_ns;
      (ends == 4 ? points.back() : points.front()).gain = random.real(0.1, 3.0);
    } else {
      if (ends & 1) points.insert(points.begin(), {early_ns, random.real(0.1, 3.0)});
      if (ends & 2) points.push_back({late_ns, random.real(0.1, 3.0)});
    }
    function = GainFunction(std::move(points));
  }
}

}  // namespace nutik::test
