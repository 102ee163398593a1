#include "render/picture_memory.hpp"

#include <algorithm>
#include <cstdint>

#include "imev/tile.hpp"

namespace nutik {
namespace {

// Light that is developed part by part (opencl/developer.cpp), in each of the places where a part is.
constexpr std::uint64_t kPartBytes = 12 << 20;

}  // namespace

MemoryNeeds picture_needs(const Shape& shape, ValueType type, std::size_t sum_bytes) {
  const std::uint64_t pixels = TileGrid(shape).tile_count() * kTilePixels;
  const std::uint64_t values = pixels * shape.channels;
  const std::uint64_t parts = std::min(kPartBytes, values * 3 * kMaxSumBytes);
  return {{"sums", values * sum_bytes},
          {"functions of pixels", 2 * pixels},
          {"the picture", 2 * shape.value_count() * value_bytes(type) + parts}};
}

}  // namespace nutik
