// A mask over a picture, so that people see which pixels have which tag.
#pragma once

#include "capture/picture.hpp"
#include "exposure/mask.hpp"

namespace nutik::sheet {

// Every tag but 0 as a colour over the greys of the picture, with its number where its region is widest, and
// below it a legend: colour, tag, pixels. Tag 0 shows the picture as it is. The picture is one of codes, of the
// mask's size; a small one is enlarged by a whole number. Pixels that are not square are drawn as long as they are
// shown, so that the overlay's are.
[[nodiscard]] Picture mask_overlay(const Mask& mask, const Picture& picture);

}  // namespace nutik::sheet
