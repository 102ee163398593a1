// Pictures of the engine as Qt draws them.
#pragma once

#include <QImage>

#include "session/session.hpp"

namespace nutik::studio {

// For 8-bit codes, one channel or three; Format_RGB32.
[[nodiscard]] QImage image_of(const Picture& picture);

// How pictures on the screen are stored: 8-bit sRGB.
[[nodiscard]] OutputFormat screen_format();

[[nodiscard]] QRect rectangle_of(const Rectangle& rectangle);
// The part of it that a picture of this shape has.
[[nodiscard]] Rectangle rectangle_of(const QRect& rectangle, const Shape& shape);

}  // namespace nutik::studio
