#include "imev/activity.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>

namespace nutik {

Activity::Activity(const CaptureFormat& capture, ActivityOptions options)
    : shape_(capture.shape), options_(std::move(options)), changes_(capture.shape.pixel_count()) {
  if (!options_.counted.empty() && options_.counted.size() != changes_.size()) {
    throw std::logic_error("the pixels that count are not those of the capture");
  }
  if (!options_.tags.empty() && options_.tags.size() != changes_.size()) {
    throw std::logic_error("tags are not those of the capture's pixels");
  }
  for (const std::uint8_t tag : options_.tags) changed_by_tag_[tag];
}

bool Activity::is_change(const ChangeRecord& before, const ChangeRecord& after) const {
  for (std::uint32_t channel = 0; channel < shape_.channels; ++channel) {
    const int difference = after.codes[channel] - before.codes[channel];
    if (static_cast<std::uint32_t>(std::abs(difference)) > options_.ignored_codes) return true;
  }
  return false;
}

void Activity::add(const BlockView& block) {
  const TileGrid grid(shape_);
  const bool is_first = last_.empty();
  last_.resize(changes_.size());
  const std::size_t first_sample = changed_pixels_.size();
  changed_pixels_.resize(first_sample + block.extent().sample_count);
  std::array<std::uint64_t*, 256> changed_of_tag{};  // at the block's first sample
  for (auto& [tag, changed] : changed_by_tag_) {
    changed.resize(changed_pixels_.size());
    changed_of_tag[tag] = changed.data() + first_sample;
  }
  std::vector<ChangeRecord> history;
  std::uint64_t pixel = 0;
  for (std::uint32_t y = 0; y < shape_.height; ++y) {
    for (std::uint32_t x = 0; x < shape_.width; ++x, ++pixel) {
      if (!options_.counted.empty() && options_.counted[pixel] == 0) continue;
      block.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
      const ChangeRecord* before = is_first ? nullptr : &last_[pixel];
      for (const ChangeRecord& record : history) {
        if (before != nullptr && is_change(*before, record)) {
          ++changes_[pixel];
          ++changed_pixels_[first_sample + record.sample];
          if (!options_.tags.empty()) ++changed_of_tag[options_.tags[pixel]][record.sample];
        }
        before = &record;
      }
      last_[pixel] = history.back();
    }
  }
}

std::uint64_t Activity::pixel_count() const {
  if (options_.counted.empty()) return changes_.size();
  return static_cast<std::uint64_t>(std::ranges::count(options_.counted, std::uint8_t{1}));
}

}  // namespace nutik
