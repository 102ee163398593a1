// 8-bit YUV as 8-bit RGB.
//
//   in:      a picture of YUV, the matrix and the range of its codes
//   out:     for every pixel the nearest codes to what matrix and range make of its luma and of the chroma sample that
//            it shares with its neighbours, within 0.53 of a code
//   always:  whole numbers alone, so that every machine makes the same codes
#pragma once

#include <cstddef>
#include <cstdint>

#include "media/videos/pixels.hpp"

namespace nutik::videos {

// Whether a picture's luma and chroma lie in a plane each, a byte a value, as eight_bit_rgb() reads them.
[[nodiscard]] bool has_byte_planes(AVPixelFormat format);
// The format with such planes that keeps as much chroma.
[[nodiscard]] AVPixelFormat with_byte_planes(AVPixelFormat format);

inline constexpr double kMostOff = 0.525;  // of a code

// Writes RGB, three bytes a pixel, rows `stride` bytes apart.
void eight_bit_rgb(const AVFrame& frame, const YuvCoding& coding, std::uint8_t* rgb, std::ptrdiff_t stride);

}  // namespace nutik::videos
