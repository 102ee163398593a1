// Regions that grow and shrink, by exact distances between the centres of pixels.
//
//   in:      a region of any size
//   out:     distances in pixels, straight ones; another region of the same size
//   always:  no square or diamond stands in for a circle
#pragma once

#include "mask/region.hpp"

namespace nutik {

// For every pixel the squared distance to the nearest one inside, 0 for those themselves; kFarAway where the
// region is empty. Exact, in a time that grows with the number of pixels alone.
inline constexpr std::uint64_t kFarAway = std::uint64_t{1} << 62;
[[nodiscard]] std::vector<std::uint64_t> squared_distances(const Region& region);

// The pixels at most `radius` away from one inside; those further than `radius` from every one outside. What
// lies beyond the picture's border is taken for neither, so that a region does not shrink from there.
// radius >= 0.
[[nodiscard]] Region grown(const Region& region, double radius);
[[nodiscard]] Region shrunk(const Region& region, double radius);

// Without parts and bridges narrower than 2 · radius, then without holes and bays that narrow.
[[nodiscard]] Region smoothed(const Region& region, double radius);

}  // namespace nutik
