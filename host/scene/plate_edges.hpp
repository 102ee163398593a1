// Whether a region that differs from the plate is a thing before it, or a hole that a thing left: the plate shows a thing
// where it was for half of the time or more.
#pragma once

#include "capture/picture.hpp"
#include "mask/region.hpp"

namespace nutik {

// Of the region's border, the share along which the plate has an edge, and the picture none: about 0 of a thing, 1 of a
// hole, and between these of a thing of which the plate shows a part. An edge differs by more than `by_codes`. The region
// reaches `margin` pixels over what differs. Both pictures hold codes of one type, and have the region's size. 0 for a
// region that is too small to tell.
[[nodiscard]] double plate_edge_share(const Picture& picture, const Picture& plate, const Region& region,
                                      std::uint32_t by_codes, std::uint32_t margin);

}  // namespace nutik
