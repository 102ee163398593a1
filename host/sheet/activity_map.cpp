#include "sheet/activity_map.hpp"

#include <algorithm>
#include <cmath>

#include "capture/transfer.hpp"

namespace nutik::sheet {

Picture activity_map(const Shape& shape, std::span<const std::uint64_t> changes) {
  Picture map({shape.width, shape.height, 1}, ValueType::code8, 255);
  const double most = static_cast<double>(std::max<std::uint64_t>(*std::ranges::max_element(changes), 1));
  const Transfer srgb = Transfer::srgb();
  map.transfer = srgb;
  std::ranges::transform(changes, map.values<std::uint8_t>().begin(), [&](std::uint64_t count) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb.fraction_of(static_cast<double>(count) / most)));
  });
  return map;
}

}  // namespace nutik::sheet
