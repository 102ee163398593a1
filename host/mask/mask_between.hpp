// Masks between two key frames.
//
//   in:      two masks of one size, and how far a moment lies between them
//   out:     the mask of that moment
//   always:  at a key it is the key's own; the same on every machine, for it follows from whole numbers, quotients,
//            square roots and sums of doubles alone
#pragma once

#include <cstdint>
#include <string>

#include "exposure/mask.hpp"

namespace nutik {

enum class MaskBlend {
  distance,  // edges move: hard masks that have the same tags
  alpha,     // one fades into the other: every pixel has a share of both
};

// Shares of the way are whole 65536ths.
inline constexpr std::uint32_t kWholeWay = 65'536;

// By distance: every tag has a distance to its edge at each pixel, positive within, in pixels. They are mixed as
// (1 − λ) a + λ b, and the pixel gets the tag whose mixture is the largest, of equals the lowest.
// By alpha: a pixel has (1 − λ) of its shares in `a` and λ of those in `b`, as whole 65535ths that add up.
// `way` counts up to kWholeWay. Throws InputError naming both where sizes differ, and by distance where a mask is soft
// or a tag is in one of them only.
[[nodiscard]] Mask mask_between(const Mask& a, const std::string& a_name, const Mask& b,
                                const std::string& b_name, MaskBlend blend, std::uint32_t way);

}  // namespace nutik
