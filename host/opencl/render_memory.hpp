// How a render shares out its memory among the picture, tables and blocks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/memory_needs.hpp"
#include "opencl/block_feed.hpp"
#include "render/renderer.hpp"

namespace nutik {

struct RenderMemory {
  FeedLimits feed;
  std::uint64_t kept_bytes = 0;   // of sums of blocks that stay (kept_sums.hpp), in each arithmetic,
  std::uint64_t held_bytes = 0;   // and of the last exposure's (LastExposure)
  std::uint64_t slice_bytes = 0;  // of weights and as many of boundaries (allocation_cuts.hpp)
};

// All of `memory_bytes` is for blocks: half for those of the resident capture.
[[nodiscard]] RenderMemory memory_for_blocks(std::uint64_t memory_bytes);

// What a render of so many pixels takes at the least: picture, the tables of a block and one block.
struct LeastMemory {
  MemoryNeeds needs;
  std::uint64_t block_bytes = 0;
  std::uint64_t table_bytes = 0;
};
[[nodiscard]] LeastMemory least_memory(const RenderPlan& plan, const CaptureSource& source, const Shape& picture,
                                       ValueType type, Precision precision);

// Shares `allowed` bytes among everything. Throws MemoryTooLittle where the least takes more.
[[nodiscard]] RenderMemory memory_for_render(std::uint64_t allowed, const RenderPlan& plan,
                                             const CaptureSource& source, const Shape& picture,
                                             ValueType type, Precision precision);

// What each device may take for its band of a picture that they make side by side (BandSplit::cut()), of `allowed`
// bytes for everything; 0 is as much as they like. The whole picture is held besides. Throws MemoryTooLittle where some
// bands of that picture would take more: what is refused must not depend on how fast devices have been.
[[nodiscard]] std::vector<std::uint64_t> memory_of_bands(std::uint64_t allowed, const RenderPlan& plan,
                                                         const CaptureSource& source,
                                                         std::span<const Rectangle> bands, ValueType type,
                                                         Precision precision);

}  // namespace nutik
