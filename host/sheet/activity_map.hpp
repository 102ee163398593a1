// Where a capture changes, as a picture.
#pragma once

#include <cstdint>
#include <span>

#include "capture/picture.hpp"

namespace nutik::sheet {

// A grey picture of 8 bits of a capture of this shape: light is the share of the most changes that any pixel has, shown
// through the sRGB curve so that rare changes can be seen. `changes` has a number for each pixel, row-major.
[[nodiscard]] Picture activity_map(const Shape& shape, std::span<const std::uint64_t> changes);

}  // namespace nutik::sheet
