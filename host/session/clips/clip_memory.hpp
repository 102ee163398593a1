// How a clip's reader divides its memory.
//
//   in:      the budget, the format of the clip's samples, what its decoder needs
//   out:     how far ahead is decoded, when blocks close, how many threads pack
//   always:  the parts together stay within the budget, or MemoryTooLittle says the least that works
#pragma once

#include <cstdint>
#include <optional>

#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "imev/block_builder.hpp"
#include "session/memory_budget.hpp"

namespace nutik {

struct ClipMemory {
  std::uint64_t read_ahead_bytes = 0;
  BlockLimits blocks = {kDefaultBlockSamples};  // of a file
  std::uint32_t stream_samples = 0;             // of a stream's blocks
  std::uint32_t threads = 1;                    // that pack
  std::uint64_t bytes = 0;                      // all of it, when a clip is streamed
};

// What a clip's memory follows from.
struct ClipToRead {
  CaptureFormat capture;  // of its samples
  std::uint64_t decoder_bytes = 0;
  std::optional<std::uint32_t> block_samples;  // as stated
  std::uint64_t announced_samples = 0;         // 0: they are not
  bool tells_changes = false;                  // rather than pictures
};

// For encoding. `rendering` is what a later render will need; blocks stay small enough to fit beside it.
// Throws MemoryTooLittle, UsageError where blocks of the stated length do not fit.
[[nodiscard]] ClipMemory memory_for_encoding(const MemoryBudget& budget, const ClipToRead& clip,
                                             const MemoryNeeds& rendering = {});

// For rendering while the clip is read: `rendering` is held at the same time.
[[nodiscard]] ClipMemory memory_for_streaming(const MemoryBudget& budget, const ClipToRead& clip,
                                              const MemoryNeeds& rendering);

}  // namespace nutik
