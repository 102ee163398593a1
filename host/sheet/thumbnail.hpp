// Small pictures of large ones.
#pragma once

#include "capture/picture.hpp"

namespace nutik::sheet {

// A picture of codes at another size, as 8-bit sRGB: each pixel has the mean light of the area that it covers,
// so that fine bright patterns keep their brightness. Channels stay as they are. Codes of which nobody said what they
// stand for are taken to be sRGB.
[[nodiscard]] Picture thumbnail(const Picture& picture, std::uint32_t width, std::uint32_t height);

// The same as large as fits into a square of `side` pixels, and no larger than the picture is shown: with
// CaptureFormat::shown_shape(), in square pixels.
[[nodiscard]] Picture fitted_thumbnail(const Picture& picture, const Shape& shown, std::uint32_t side);

}  // namespace nutik::sheet
