// Prediction of one channel of one row of a tile; see prediction.hpp for what is made of it.
#pragma once

#include <array>
#include <cstdint>

#include "tik/residual_packing.hpp"

namespace nutik::tik {

// How a row is predicted. The values stand in files.
enum class Mode : std::uint8_t {
  before,      // the row before
  neighbours,  // the median of left, above, and left + above - left above, in the same row
  drift        // the row before, plus that median of the differences from it
};
inline constexpr std::uint8_t kModes = 3;

// One channel of one row.
template <typename Code>
using Plane = std::array<Code, kTilePixels>;

// The mode whose residuals are smallest, and those residuals. A tile's first row has nothing `before` it but the value
// that its first pixel is predicted from, before[0].
[[nodiscard]] Mode choose_mode(const Plane<std::uint8_t>& now, const Plane<std::uint8_t>& before,
                               bool is_first, Residuals& residuals);
[[nodiscard]] Mode choose_mode(const Plane<std::uint16_t>& now, const Plane<std::uint16_t>& before,
                               bool is_first, Residuals& residuals);

// What residuals and the row before make `now` again, modulo the range of codes.
void add_residuals(Mode mode, const Residuals& residuals, const Plane<std::uint8_t>& before,
                   Plane<std::uint8_t>& now);
void add_residuals(Mode mode, const Residuals& residuals, const Plane<std::uint16_t>& before,
                   Plane<std::uint16_t>& now);

}  // namespace nutik::tik
