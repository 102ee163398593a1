// A walk over a capture's blocks, for whatever looks at all of its samples or at some.
#pragma once

#include "imev/capture_source.hpp"

namespace nutik {

// Calls visit(BlockView) for each block that holds any of the samples [first, last), in time order. Throws
// InputError where a block is damaged.
template <typename Visit>
void for_each_block(CaptureSource& source, SampleRange samples, Visit visit) {
  PageBuffer payload;
  for (std::uint64_t block = 0; block < source.block_count(); ++block) {
    const SampleRange held = source.block_extent(block).range();
    if (held.last <= samples.first || held.first >= samples.last) continue;
    const std::uint64_t bytes = source.prepare(block);
    payload.reserve(bytes);
    source.read(block, payload.first(bytes));
    visit(BlockView(source.format(), source.block_extent(block), payload.first(bytes)));
  }
}

template <typename Visit>
void for_each_block(CaptureSource& source, Visit visit) {
  for_each_block(source, {0, source.timeline().sample_count()}, visit);
}

}  // namespace nutik
