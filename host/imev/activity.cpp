#include "imev/activity.hpp"

#include <algorithm>
#include <cmath>

#include "capture/transfer.hpp"

namespace nutik {

Activity::Activity(const CaptureFormat& capture)
    : shape_(capture.shape), changes_(capture.shape.pixel_count()) {}

void Activity::add(const BlockView& block) {
  const TileGrid grid(shape_);
  const bool is_first = last_.empty();
  last_.resize(changes_.size());
  std::vector<ChangeRecord> history;
  std::uint64_t pixel = 0;
  for (std::uint32_t y = 0; y < shape_.height; ++y) {
    for (std::uint32_t x = 0; x < shape_.width; ++x, ++pixel) {
      block.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
      changes_[pixel] += history.size() - 1;
      if (!is_first && history.front().codes != last_[pixel].codes) ++changes_[pixel];
      last_[pixel] = history.back();
    }
  }
}

Picture activity_map(const Shape& shape, const std::vector<std::uint64_t>& changes) {
  Picture map({shape.width, shape.height, 1}, ValueType::code8, 255);
  const double most = static_cast<double>(std::max<std::uint64_t>(*std::ranges::max_element(changes), 1));
  const Transfer srgb = Transfer::srgb();
  std::ranges::transform(changes, map.values<std::uint8_t>().begin(), [&](std::uint64_t count) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb.fraction_of(static_cast<double>(count) / most)));
  });
  return map;
}

}  // namespace nutik
