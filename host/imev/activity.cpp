#include "imev/activity.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <stdexcept>

namespace nutik {
namespace {

constexpr std::uint64_t kStretchesInACapture = 20;

}  // namespace

std::vector<std::uint64_t> redrawn_samples(const Activity& activity) {
  const std::vector<std::uint64_t>& changed = activity.any_changed_pixels();
  const std::vector<std::uint64_t>& much = activity.much_changed_pixels();
  const std::uint64_t pixels = activity.changes().size();
  std::vector<std::uint64_t> redrawn;
  for (std::uint64_t k = 1; k < changed.size(); ++k) {
    // The first sample cannot change.
    const std::uint64_t before = k > 1 ? changed[k - 1] : 0;
    const std::uint64_t after = k + 1 < changed.size() ? changed[k + 1] : 0;
    const bool has_beside = k > 1 || k + 1 < changed.size();
    if (has_beside && 4 * changed[k] >= pixels && 2 * changed[k] >= 3 * std::max(before, after) &&
        4 * much[k] < changed[k])
      redrawn.push_back(k);
  }
  return redrawn;
}

std::optional<ActivityMoments> activity_moments(std::span<const std::uint64_t> changed_pixels) {
  const std::uint64_t count = changed_pixels.size();
  if (count < 3) return std::nullopt;
  const auto busiest = std::max_element(changed_pixels.begin() + 1, changed_pixels.end());
  if (*busiest == 0) return std::nullopt;
  const std::uint64_t length = std::max<std::uint64_t>(1, count / kStretchesInACapture);
  const auto front = changed_pixels.subspan(1, length);
  ActivityStretch stretch{{1, 1 + length}, std::accumulate(front.begin(), front.end(), std::uint64_t{0})};
  ActivityMoments moments{static_cast<std::uint64_t>(busiest - changed_pixels.begin()), stretch, stretch};
  while (stretch.samples.last < count) {
    stretch.changes += changed_pixels[stretch.samples.last++];
    stretch.changes -= changed_pixels[stretch.samples.first++];
    if (stretch.changes > moments.busiest.changes) moments.busiest = stretch;
    if (stretch.changes < moments.quietest.changes) moments.quietest = stretch;
  }
  return moments;
}

Activity::Activity(const CaptureFormat& capture, ActivityOptions options)
    : shape_(capture.shape),
      much_(capture.white_code / 16),
      options_(std::move(options)),
      changes_(capture.shape.pixel_count()) {
  if (!options_.counted.empty() && options_.counted.size() != changes_.size()) {
    throw std::logic_error("the pixels that count are not those of the capture");
  }
  if (!options_.tags.empty() && options_.tags.size() != changes_.size()) {
    throw std::logic_error("tags are not those of the capture's pixels");
  }
  for (const std::uint8_t tag : options_.tags) changed_by_tag_[tag];
}

std::uint32_t Activity::change(const ChangeRecord& before, const ChangeRecord& after) const {
  int largest = 0;
  for (std::uint32_t channel = 0; channel < shape_.channels; ++channel)
    largest = std::max(largest, std::abs(after.codes[channel] - before.codes[channel]));
  return static_cast<std::uint32_t>(largest);
}

void Activity::add(const BlockView& block, const std::function<void(std::uint32_t y)>& begin_row) {
  const TileGrid grid(shape_);
  const bool is_first = last_.empty();
  last_.resize(changes_.size());
  const std::size_t first_sample = changed_pixels_.size();
  changed_pixels_.resize(first_sample + block.extent().sample_count);
  any_changed_pixels_.resize(changed_pixels_.size());
  much_changed_pixels_.resize(changed_pixels_.size());
  std::vector<bool> is_left_out(block.extent().sample_count);
  for (const std::uint64_t sample : options_.left_out) {
    if (sample >= first_sample && sample < changed_pixels_.size()) is_left_out[sample - first_sample] = true;
  }
  std::array<std::uint64_t*, 256> changed_of_tag{};  // at the block's first sample
  for (auto& [tag, changed] : changed_by_tag_) {
    changed.resize(changed_pixels_.size());
    changed_of_tag[tag] = changed.data() + first_sample;
  }
  std::vector<ChangeRecord> history;
  std::uint64_t pixel = 0;
  for (std::uint32_t y = 0; y < shape_.height; ++y) {
    if (begin_row) begin_row(y);
    for (std::uint32_t x = 0; x < shape_.width; ++x, ++pixel) {
      const bool counts = options_.counted.empty() || options_.counted[pixel] != 0;
      block.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
      const ChangeRecord* before = is_first ? nullptr : &last_[pixel];
      for (const ChangeRecord& record : history) {
        const std::uint32_t by = before == nullptr ? 0 : change(*before, record);
        const std::uint64_t sample = first_sample + record.sample;
        if (by > 0) ++any_changed_pixels_[sample];
        if (by > much_) ++much_changed_pixels_[sample];
        if (counts && by > options_.ignored_codes && !is_left_out[record.sample]) {
          ++changes_[pixel];
          ++changed_pixels_[sample];
          if (!options_.tags.empty()) ++changed_of_tag[options_.tags[pixel]][record.sample];
        }
        before = &record;
      }
      last_[pixel] = history.back();
    }
  }
}

void Activity::bridge_left_out() {
  const auto bridge = [&](std::vector<std::uint64_t>& changed) {
    for (const std::uint64_t k : options_.left_out) {
      std::uint64_t sum = 0, count = 0;
      for (const std::uint64_t beside : {k - 1, k + 1}) {
        if (beside == 0 || beside >= changed.size()) continue;  // the first sample cannot change
        sum += changed[beside];
        ++count;
      }
      changed[k] = count == 0 ? 0 : (sum + count / 2) / count;
    }
  };
  bridge(changed_pixels_);
  for (auto& [tag, changed] : changed_by_tag_) bridge(changed);
}

std::uint64_t Activity::pixel_count() const {
  if (options_.counted.empty()) return changes_.size();
  return static_cast<std::uint64_t>(std::ranges::count(options_.counted, std::uint8_t{1}));
}

}  // namespace nutik
