// The host's side of kernels/layout.clh and of the structures of kernels/arithmetic.clh.
#pragma once

#include <cstddef>
#include <cstdint>

#include "imev/block.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// A block within a chunk. Mirrors BlockEntry in kernels/layout.clh.
struct BlockEntry {
  std::uint64_t payload_offset;  // bytes from the chunk's start
  std::uint64_t table_row;       // of its first sample in the tables of its slice
  std::uint64_t span_row;        // in the spans of its slice
  std::uint32_t sample_count;
  std::uint32_t unused;
};
static_assert(sizeof(BlockEntry) == 32 && offsetof(BlockEntry, sample_count) == 24);
static_assert(sizeof(TileEntry) == 8 && sizeof(SampleSpan) == 4);
static_assert(kBlockAlignment == 64 && kTilePixels == 64);

// In function_of_tile: the tile's pixels have several functions.
inline constexpr std::uint16_t kMixedFunctions = 0xFFFF;

// What brings the sums of one function onto the scale of the thresholds. Mirrors LightScale in
// kernels/floating.clh and kernels/compensated.clh …
template <typename Real>
struct LightScale {
  Real first;
  Real second;
};
static_assert(sizeof(LightScale<float>) == 2 * sizeof(float) &&
              sizeof(LightScale<double>) == 2 * sizeof(double));

// … and in kernels/fixed.clh.
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
