// Small holes of a region: what it surrounds, and no more than so many pixels of it.
#pragma once

#include <cstddef>

#include "mask/region.hpp"

namespace nutik {

// Adds them to the region. A hole that hangs together, also over corners, with the picture's border or with more than
// `max_pixels` stays. Takes a byte a pixel.
void fill_small_holes(Region& region, std::size_t max_pixels);

}  // namespace nutik
