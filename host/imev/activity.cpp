#include "imev/activity.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <list>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "system/parallel.hpp"

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

// What one thread counts of a block, by sample.
struct Activity::Counts {
  Counts(std::size_t samples, const std::map<std::uint8_t, std::vector<std::uint64_t>>& tags)
      : changed(samples), any(samples), much(samples) {
    for (const auto& [tag, counts] : tags) by_tag[tag].resize(samples);
  }

  std::vector<std::uint64_t> changed, any, much;
  std::array<std::vector<std::uint64_t>, 256> by_tag;
};

// A tile of the picture: which of its lanes are pixels, which of these count, and how often each of them changed.
struct Activity::Tile {
  Tile(const Shape& shape, const ActivityOptions& options, std::uint64_t of) : number(of) {
    const TileGrid grid(shape);
    grid.for_each_lane(of, [&](std::uint32_t lane, std::uint64_t pixel) {
      pixels[lane] = pixel;
      // A lane beside the picture is told the pixel of another one.
      inside[lane] = TileGrid::lane_of(static_cast<std::uint32_t>(pixel % shape.width),
                                       static_cast<std::uint32_t>(pixel / shape.width)) == lane;
      counted[lane] = inside[lane] != 0 && (options.counted.empty() || options.counted[pixel] != 0);
    });
  }

  std::uint64_t number;
  std::array<std::uint64_t, kTilePixels> pixels{};
  std::array<std::uint8_t, kTilePixels> inside{}, counted{};
  std::array<std::uint32_t, kTilePixels> changes{};
};

// Rows of a tile are compared as a whole, which processors do in vectors.
template <typename Code>
void Activity::add_rows(const BlockView& block, const std::vector<bool>& is_left_out, Tile& tile, Counts& counts) {
  const std::size_t values = std::size_t{shape_.channels} * kTilePixels;
  std::uint16_t* const last = last_.data() + tile.number * values;
  std::array<Code, 3 * kTilePixels> before;
  std::copy_n(last, values, before.begin());
  constexpr std::uint32_t kLargest = static_cast<Code>(~Code{0});
  const auto ignored = static_cast<Code>(std::min(options_.ignored_codes, kLargest));
  const auto much = static_cast<Code>(much_);
  const Code* from = changed_pixels_.empty() ? nullptr : before.data();
  block.for_each_row(tile.number, [&](std::uint32_t sample, std::uint32_t, const std::byte* bytes) {
    const auto* const codes = reinterpret_cast<const Code*>(bytes);
    const Code* const held = std::exchange(from, codes);
    if (held == nullptr) return;
    std::array<Code, kTilePixels> by{};
    for (std::size_t first = 0; first < values; first += kTilePixels) {
      for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
        const Code a = held[first + lane], b = codes[first + lane];
        by[lane] = std::max(by[lane], static_cast<Code>(std::max(a, b) - std::min(a, b)));
      }
    }
    std::array<std::uint8_t, kTilePixels> is_change{};
    std::uint32_t any = 0, many = 0, changed = 0;
    for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
      any += static_cast<std::uint8_t>(tile.inside[lane] & (by[lane] > 0));
      many += static_cast<std::uint8_t>(tile.inside[lane] & (by[lane] > much));
      is_change[lane] = static_cast<std::uint8_t>(tile.counted[lane] & (by[lane] > ignored));
    }
    counts.any[sample] += any;
    counts.much[sample] += many;
    if (is_left_out[sample]) return;
    for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
      changed += is_change[lane];
      tile.changes[lane] += is_change[lane];
    }
    counts.changed[sample] += changed;
    for (std::size_t lane = 0; lane < kTilePixels && !options_.tags.empty(); ++lane)
      if (is_change[lane] != 0) ++counts.by_tag[options_.tags[tile.pixels[lane]]][sample];
  });
  std::copy_n(from, values, last);
}

void Activity::add_records(const BlockView& block, const std::vector<bool>& is_left_out, Tile& tile, Counts& counts) {
  std::vector<ChangeRecord> history;
  std::uint16_t* const last = last_.data() + tile.number * shape_.channels * kTilePixels;
  for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
    block.read_history(tile.number, lane, history);
    bool has_before = !changed_pixels_.empty();
    for (const ChangeRecord& record : history) {
      int by = 0;
      for (std::uint32_t channel = 0; channel < shape_.channels; ++channel) {
        std::uint16_t& held = last[channel * kTilePixels + lane];
        if (has_before) by = std::max(by, std::abs(record.codes[channel] - held));
        held = record.codes[channel];
      }
      has_before = true;
      if (by == 0 || tile.inside[lane] == 0) continue;
      const auto codes = static_cast<std::uint32_t>(by);
      ++counts.any[record.sample];
      counts.much[record.sample] += codes > much_;
      if (tile.counted[lane] == 0 || codes <= options_.ignored_codes || is_left_out[record.sample]) continue;
      ++tile.changes[lane];
      ++counts.changed[record.sample];
      if (!options_.tags.empty()) ++counts.by_tag[options_.tags[tile.pixels[lane]]][record.sample];
    }
  }
}

void Activity::add(const BlockView& block, const std::function<void(std::uint32_t rows)>& done_rows) {
  const TileGrid grid(shape_);
  last_.resize(grid.tile_count() * shape_.channels * kTilePixels);
  const std::size_t first_sample = changed_pixels_.size(), samples = block.extent().sample_count;
  std::vector<bool> is_left_out(samples);
  for (const std::uint64_t sample : options_.left_out) {
    if (sample >= first_sample && sample < first_sample + samples) is_left_out[sample - first_sample] = true;
  }
  std::mutex telling;
  std::uint32_t rows = 0;
  std::list<Counts> counts;  // of each thread
  parallel_for_with(
      grid.rows(),
      [&] {
        const std::scoped_lock lock(telling);
        return &counts.emplace_back(samples, changed_by_tag_);
      },
      [&](std::uint64_t row, Counts* own) {
        for (std::uint64_t number = row * grid.columns(); number < (row + 1) * grid.columns(); ++number) {
          Tile tile(shape_, options_, number);
          if (block.entry(number).is_records()) {
            add_records(block, is_left_out, tile, *own);
          } else if (block.geometry().code_bytes == 1) {
            add_rows<std::uint8_t>(block, is_left_out, tile, *own);
          } else {
            add_rows<std::uint16_t>(block, is_left_out, tile, *own);
          }
          for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
            if (tile.inside[lane] != 0) changes_[tile.pixels[lane]] += tile.changes[lane];
          }
        }
        const std::scoped_lock lock(telling);
        rows = std::min(rows + kTileSide, shape_.height);
        if (done_rows) done_rows(rows);
      });
  const auto add_up = [&](std::vector<std::uint64_t>& all, auto part) {
    all.resize(first_sample + samples);
    for (const Counts& each : counts)
      for (std::size_t k = 0; k < samples; ++k) all[first_sample + k] += part(each)[k];
  };
  add_up(changed_pixels_, [](const Counts& each) -> const auto& { return each.changed; });
  add_up(any_changed_pixels_, [](const Counts& each) -> const auto& { return each.any; });
  add_up(much_changed_pixels_, [](const Counts& each) -> const auto& { return each.much; });
  for (auto& [tag, changed] : changed_by_tag_)
    add_up(changed, [of = tag](const Counts& each) -> const auto& { return each.by_tag[of]; });
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
