// How often each pixel of a capture changes.
#pragma once

#include <cstdint>
#include <vector>

#include "capture/picture.hpp"
#include "imev/block.hpp"

namespace nutik {

// Counts, block after block, the samples at which a pixel holds other codes than at the sample before;
// also where a block begins, though that is no change record.
class Activity {
 public:
  explicit Activity(const CaptureFormat& capture);

  // Adds the next block; blocks must come in order, all of them.
  void add(const BlockView& block);

  // Changes of every pixel, row-major.
  [[nodiscard]] const std::vector<std::uint64_t>& changes() const { return changes_; }

 private:
  Shape shape_;
  std::vector<std::uint64_t> changes_;
  std::vector<ChangeRecord> last_;  // what each pixel held at the end of the block before; empty at first
};

// The map as a grey picture of 8 bits: light is the share of the most changes that any pixel has, shown
// through the sRGB curve so that rare changes can be seen.
[[nodiscard]] Picture activity_map(const Shape& shape, const std::vector<std::uint64_t>& changes);

}  // namespace nutik
