// The colours that red, green and blue light have, and what they are in those of screens.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace nutik {

// BT.709, which are sRGB's too; BT.2020, which are BT.2100's; P3 with the white of screens (SMPTE EG 432-1); those of
// cameras' curves, from the papers that log_curve.cpp names; ACES' AP1 and AP0; Adobe RGB (1998); P3 with cinemas'
// white (SMPTE RP 431-2). All but those of ACES and of cinemas have the white D65.
enum class Primaries {
  bt709, bt2020, p3, sgamut3, sgamut3_cine, vgamut, cinema_gamut, arri_wg3, arri_wg4, dgamut, apple_wide_gamut, ap1,
  adobe_rgb, dci_p3, ap0
};
[[nodiscard]] std::span<const Primaries> all_primaries();

// `bt709`, `bt2020`, `p3`, `sgamut3-cine` ….
[[nodiscard]] std::string_view to_text(Primaries primaries);
// Throws UsageError listing them.
[[nodiscard]] Primaries parse_primaries(std::string_view text);

// x and y of red, green, blue and white (CIE 1931).
[[nodiscard]] const std::array<std::array<double, 2>, 4>& chromaticities(Primaries primaries);

// Light in some primaries to the same light in others, a white that is not D65 adapted by Bradford's matrix: a row for
// each of red, green and blue.
using ColourMatrix = std::array<std::array<double, 3>, 3>;
[[nodiscard]] const ColourMatrix& to_bt709(Primaries primaries);

}  // namespace nutik
