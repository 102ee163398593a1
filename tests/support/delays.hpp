// Random time maps.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "exposure/delay_map.hpp"
#include "support/random_case.hpp"

namespace nutik::test {

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

}  // namespace nutik::test
