// The host's side of kernels/layout.clh and of the structures of kernels/arithmetic.clh.
#pragma once

#include <cstddef>
#include <cstdint>

#include "imev/block.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// What a function makes of a block. Mirrors BlockPart in kernels/layout.clh.
struct BlockPart {
  static constexpr std::uint32_t kSteady = 1, kInBundle = 2, kBundleStart = 4, kBundleEnd = 8;
  static constexpr std::uint32_t kSumShift = 8;

  SampleSpan span;
  std::uint32_t bits;
};
static_assert(sizeof(BlockPart) == 8 && offsetof(BlockPart, bits) == 4);

// A block within a chunk, or kept sums. Mirrors BlockEntry in kernels/layout.clh.
struct BlockEntry {
  std::uint64_t payload_offset;  // bytes from the chunk's start; of kept sums the place of the first, in sums
  std::uint64_t table_row;       // of its first sample in the tables of its slice
  std::uint64_t part_row;        // in the parts of its slice
  std::uint32_t sample_count;    // of kept sums 0
  std::uint32_t kept_bits;
};
static_assert(sizeof(BlockEntry) == 32 && offsetof(BlockEntry, kept_bits) == 28);

// What one launch of kernels/expose.cl is, beside its buffers. Mirrors ExposeLaunch in kernels/layout.clh.
struct ExposeLaunch {
  std::uint64_t tile_count;  // of the band
  std::uint32_t block_count;
  std::uint32_t function_count;
  std::uint32_t is_first;
  std::uint32_t unused = 0;
};
static_assert(sizeof(ExposeLaunch) == 24 && offsetof(ExposeLaunch, is_first) == 16);
static_assert(sizeof(TileEntry) == 8 && sizeof(SampleSpan) == 4);
static_assert(kBlockAlignment == 64 && kTilePixels == 64);

// In function_of_tile: the tile's pixels have several functions.
inline constexpr std::uint16_t kMixedFunctions = 0xFFFF;

// What brings the sums of one function onto the scale of the thresholds. Mirrors LightScale in kernels/floating.clh and
// kernels/compensated.clh.
template <typename Real>
struct LightScale {
  Real first;
  Real second;
};
static_assert(sizeof(LightScale<float>) == 2 * sizeof(float) &&
              sizeof(LightScale<double>) == 2 * sizeof(double));

// The same of whole numbers. Mirrors LightScale in kernels/fixed.clh.
struct FixedLightScale {
  std::uint32_t left;
  std::uint32_t right;
};
static_assert(sizeof(FixedLightScale) == 8);

// Mirrors Pair in kernels/compensated.clh.
struct FloatPair {
  float high;
  float low;
};
static_assert(sizeof(FloatPair) == 8);

}  // namespace nutik
