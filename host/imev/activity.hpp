// How often each pixel of a capture changes, and how many change at each sample.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "imev/block.hpp"
#include "system/parallel.hpp"

namespace nutik {

// Where a capture is busy and where it is quiet: the moments to look at first.

// A run of samples, and how many changes of pixels it has.
struct ActivityStretch {
  SampleRange samples;
  std::uint64_t changes = 0;

  // The share of so many pixels that changes at a sample, on average.
  [[nodiscard]] double mean_share(std::uint64_t pixels) const {
    return static_cast<double>(changes) / static_cast<double>(pixels) / static_cast<double>(samples.size());
  }
};

struct ActivityMoments {
  std::uint64_t busiest_sample = 0;  // at which most pixels change; the first of several
  ActivityStretch busiest;
  ActivityStretch quietest;
};

// Stretches are a twentieth of the capture long, one sample at least; of several alike the first is taken. The
// first sample, which can have no change, lies in none. Empty where there are fewer than three samples or
// nothing ever changes. `changed_pixels` has the number of pixels for each sample.
[[nodiscard]] std::optional<ActivityMoments> activity_moments(std::span<const std::uint64_t> changed_pixels);

// What counts as a change.
struct ActivityOptions {
  // Differences of up to this many codes, of every channel, are none: for noise that the capture kept.
  std::uint32_t ignored_codes = 0;
  std::vector<std::uint8_t> counted;  // a 1 for each pixel that counts, row-major; empty: all of them
  std::vector<std::uint8_t> tags;     // of each pixel, to be counted by tag too; empty: they are not
  // Changes at these samples, in increasing order, are none (redrawn_samples()).
  std::vector<std::uint64_t> left_out = {};
};

// Counts, block after block, the samples at which a pixel holds other codes than at the sample before;
// also where a block begins, though that is no change record.
class Activity {
 public:
  explicit Activity(const CaptureFormat& capture, ActivityOptions options = {});

  // What it takes: the counts of pixels, what they held, which of them count.
  [[nodiscard]] static MemoryNeeds needs(const CaptureFormat& capture) {
    const std::uint64_t tiles = TileGrid(capture.shape).tile_count();
    return {{"changes of pixels", capture.shape.pixel_count() * (sizeof(std::uint64_t) + 2) +
                                      tiles * kTilePixels * capture.shape.channels * sizeof(std::uint16_t)}};
  }

  // Besides, of so many samples: their counts, of all pixels and of those with each tag, with room that they grow by;
  // and those that each thread has of a block, of so many samples at most.
  [[nodiscard]] static MemoryNeeds needs_of_samples(std::uint64_t samples, std::size_t tags, std::uint64_t block) {
    const std::uint64_t threads = core_count();
    return {{"changes of samples", (2 * samples + threads * block) * (3 + tags) * sizeof(std::uint64_t)}};
  }

  // Adds the next block; blocks must come in order, all of them. Tells done_rows(), if there is one, how many rows of
  // its pixels are done: now and then, from any thread, one at a time.
  void add(const BlockView& block, const std::function<void(std::uint32_t rows)>& done_rows = {});
  // After the last block: samples that were left out have as many changes as those beside them have on average.
  void bridge_left_out();

  // Changes of every pixel, row-major.
  [[nodiscard]] const std::vector<std::uint64_t>& changes() const { return changes_; }
  // How many pixels changed at each sample of the blocks so far; none at the first.
  [[nodiscard]] const std::vector<std::uint64_t>& changed_pixels() const { return changed_pixels_; }
  // Whatever counts: how many of all pixels changed at each sample, and how many by more than a sixteenth of white.
  [[nodiscard]] const std::vector<std::uint64_t>& any_changed_pixels() const { return any_changed_pixels_; }
  [[nodiscard]] const std::vector<std::uint64_t>& much_changed_pixels() const { return much_changed_pixels_; }
  // How many changed of the pixels with each tag that any pixel has.
  [[nodiscard]] const std::map<std::uint8_t, std::vector<std::uint64_t>>& changed_pixels_by_tag() const {
    return changed_by_tag_;
  }
  // How many pixels count.
  [[nodiscard]] std::uint64_t pixel_count() const;

 private:
  struct Counts;
  struct Tile;
  template <typename Code>
  void add_rows(const BlockView& block, const std::vector<bool>& is_left_out, Tile& tile, Counts& counts);
  void add_records(const BlockView& block, const std::vector<bool>& is_left_out, Tile& tile, Counts& counts);

  Shape shape_;
  std::uint32_t much_;  // codes
  ActivityOptions options_;
  std::vector<std::uint64_t> changes_;
  std::vector<std::uint64_t> changed_pixels_, any_changed_pixels_, much_changed_pixels_;
  std::map<std::uint8_t, std::vector<std::uint64_t>> changed_by_tag_;
  std::vector<std::uint16_t> last_;  // codes at the end of the block before, [tile][channel][lane]
};

// Samples at which a codec drew its picture anew, as it does with its key frames: pixels that are still change there,
// all at once and a little. So they do where a camera changes its exposure by a step, which counts as the same.

// In increasing order. At such a sample at least a quarter of all pixels change, half as many again as at either sample
// beside it, and less than a quarter of those by more than a sixteenth of white: what moves does not come and go within
// one sample, and a cut or a flash changes more. Files need not say which pictures these are: a clip
// that was edited shows the key frames of its source, too.
[[nodiscard]] std::vector<std::uint64_t> redrawn_samples(const Activity& activity);

}  // namespace nutik
