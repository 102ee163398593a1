// A tile's row that is told by what changes in it. Rows are codes[channel][lane].
#pragma once

#include <cstddef>
#include <cstdint>

#include "capture/picture.hpp"
#include "capture/pixel_change.hpp"

namespace nutik {

// Into all lanes that show the pixel: its own, and those outside the picture that repeat it. `row` is of the tile that
// the pixel is in.
void write_change(const CaptureFormat& capture, const PixelChange& change, std::byte* row);

// The lanes, as bits, in which any channel is further from what is held than the capture's tolerance. The others are
// given what is held.
[[nodiscard]] std::uint64_t differing_lanes(const CaptureFormat& capture, const std::byte* held,
                                            std::byte* row);

}  // namespace nutik
