// Pictures that lie on their side, or are mirrored, as they stand upright.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

// Copies a picture whose rows begin `stride` bytes apart, and whose pixels have 1, 2, 3 or 6 bytes, upright from how it
// lies, as EXIF numbers it: from 5 on, rows become columns.
inline void copy_turned(const std::byte* from, std::ptrdiff_t stride, const Shape& lies, std::size_t pixel_bytes,
                        unsigned orientation, std::byte* to) {
  auto right = static_cast<std::ptrdiff_t>(pixel_bytes), down = stride;
  std::ptrdiff_t columns = lies.width, rows = lies.height;
  if (orientation <= 1) {
    for (; rows > 0; --rows, from += down, to += columns * right) std::memcpy(to, from, lies.width * pixel_bytes);
    return;
  }
  if (orientation >= 5) std::swap(right, down), std::swap(columns, rows);
  const unsigned flips = orientation % 4;  // 2 or 3: left for right; 3 or 0: upside down
  if (flips >= 2) from += (columns - 1) * std::exchange(right, -right);
  if (flips == 3 || flips == 0) from += (rows - 1) * std::exchange(down, -down);
  const auto copy = [&]<std::ptrdiff_t bytes>(std::integral_constant<std::ptrdiff_t, bytes>) {
    constexpr std::ptrdiff_t kSide = 64;  // of squares: the cache holds what a row touches for the next
    for (std::ptrdiff_t top = 0; top < rows; top += kSide) {
      for (std::ptrdiff_t left = 0; left < columns; left += kSide) {
        for (std::ptrdiff_t y = top; y < std::min(top + kSide, rows); ++y) {
          for (std::ptrdiff_t x = left; x < std::min(left + kSide, columns); ++x)
            std::memcpy(to + (y * columns + x) * bytes, from + y * down + x * right, bytes);
        }
      }
    }
  };
  switch (pixel_bytes) {
    case 1: return copy(std::integral_constant<std::ptrdiff_t, 1>());
    case 2: return copy(std::integral_constant<std::ptrdiff_t, 2>());
    case 3: return copy(std::integral_constant<std::ptrdiff_t, 3>());
    default: return copy(std::integral_constant<std::ptrdiff_t, 6>());
  }
}

// The same of a whole raster in its place.
inline void turn_upright(std::vector<std::byte>& raster, Shape& shape, std::size_t pixel_bytes, unsigned orientation) {
  if (orientation <= 1) return;
  std::vector<std::byte> turned(raster.size());
  copy_turned(raster.data(), static_cast<std::ptrdiff_t>(shape.width * pixel_bytes), shape, pixel_bytes, orientation,
              turned.data());
  raster = std::move(turned);
  if (orientation >= 5) std::swap(shape.width, shape.height);
}

}  // namespace nutik
