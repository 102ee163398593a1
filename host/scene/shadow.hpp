// Which of what differs from the plate is a shadow: the ground, with less light on it.
//
//   in:      a picture and its plate, in codes of one type; where they differ
//   out:     that without shadows
//   always:  a shadow begins softly: from where nothing differs, the light on the ground falls by little from pixel to
//            pixel, by about as much in all colours, and never to nothing. A shadow with a hard edge stays
#pragma once

#include "capture/picture.hpp"
#include "mask/region.hpp"

namespace nutik {

[[nodiscard]] Region without_shadow(const Picture& picture, const Picture& plate, const Region& differing);

}  // namespace nutik
