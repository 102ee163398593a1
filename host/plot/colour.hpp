// Colours of drawings, told apart by every kind of colour vision and in grey. tools/fnplot has the same.
#pragma once

#include <array>
#include <cstdint>

namespace nutik::plot {

// sRGB codes as fractions; opacity 1 covers what is behind.
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
  double opacity = 1.0;

  // 0x0060a8 is (0, 96, 168).
  [[nodiscard]] static constexpr Colour of(std::uint32_t rgb, double opacity = 1.0) {
    return {((rgb >> 16) & 0xFF) / 255.0, ((rgb >> 8) & 0xFF) / 255.0, (rgb & 0xFF) / 255.0, opacity};
  }
};

inline constexpr Colour kWhite = Colour::of(0xffffff);
inline constexpr Colour kText = Colour::of(0x202020);
inline constexpr Colour kNote = Colour::of(0x505050);
inline constexpr Colour kGrid = Colour::of(0xd4d4d4);
inline constexpr Colour kZeroLine = Colour::of(0xa0a0a0);

// What adds light and what takes it away.
inline constexpr Colour kPositive = Colour::of(0x0060a8);
inline constexpr Colour kPositiveArea = Colour::of(0x9ecae9);
inline constexpr Colour kNegativeArea = Colour::of(0xfdc086);

// Several things in one drawing: Okabe and Ito's colours, from the most to the least distinct on white.
inline constexpr std::array<Colour, 7> kPalette{
    Colour::of(0x0072b2), Colour::of(0xd55e00), Colour::of(0x009e73), Colour::of(0xcc79a7),
    Colour::of(0x56b4e9), Colour::of(0xe69f00), Colour::of(0x000000)};

}  // namespace nutik::plot
