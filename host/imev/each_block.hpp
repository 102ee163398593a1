// A walk over a capture's blocks, for whatever looks at all of its samples or at some.
#pragma once

#include <algorithm>

#include "imev/capture_source.hpp"

namespace nutik {

// Looks at one block at a time; packed ones are unpacked into the same memory, one after another.
class BlockCursor {
 public:
  explicit BlockCursor(CaptureSource& source) : source_(source) {}

  // The block, until the next call; of tiles that are not wanted, bodies that mean nothing. Throws InputError where it
  // is damaged.
  [[nodiscard]] BlockView at(std::uint64_t block, const WantsTiles& wants = {}) {
    lease_ = {};  // a source may use its memory again
    lease_ = source_.acquire(block, {[this](std::uint64_t bytes) {
                                       room_.reserve(bytes);
                                       return room_.first(bytes);
                                     },
                                     wants});
    return {source_.format(), lease_.extent(), lease_.payload()};
  }

 private:
  CaptureSource& source_;
  PageBuffer room_;
  BlockLease lease_;
};

// What a walk over a source holds of its blocks.
[[nodiscard]] inline std::uint64_t largest_block(const CaptureSource& source) {
  std::uint64_t bytes = 0;
  for (std::uint64_t block = 0; block < source.block_count(); ++block) {
    bytes = std::max(bytes, source.lent_bytes(block));
  }
  return bytes;
}

// Calls visit(BlockView) for each block that holds any of the samples [first, last), in time order. Throws
// InputError where a block is damaged.
template <typename Visit>
void for_each_block(CaptureSource& source, SampleRange samples, Visit visit) {
  BlockCursor cursor(source);
  for (std::uint64_t block = 0; block < source.block_count(); ++block) {
    const SampleRange held = source.block_extent(block).range();
    if (held.last <= samples.first || held.first >= samples.last) continue;
    visit(cursor.at(block));
  }
}

template <typename Visit>
void for_each_block(CaptureSource& source, Visit visit) {
  for_each_block(source, {0, source.timeline().sample_count()}, visit);
}

}  // namespace nutik
