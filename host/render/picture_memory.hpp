// What a picture takes in memory while it is exposed and developed.
#pragma once

#include <cstddef>

#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"

namespace nutik {

// A sum in the widest arithmetics.
inline constexpr std::size_t kMaxSumBytes = 8;

// Sums and functions of all pixels, the picture itself, and as much again where it is developed. Holds for every
// renderer that keeps sums of `sum_bytes` a value.
[[nodiscard]] MemoryNeeds picture_needs(const Shape& shape, ValueType type,
                                        std::size_t sum_bytes = kMaxSumBytes);

}  // namespace nutik
