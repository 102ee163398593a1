// Packs a row of 64 residuals of one channel by how far they reach from 0, and unpacks it.
//
//   reach      |residual|     packed
//   none       0              nothing
//   one        up to 1        13 bytes, 5 residuals each: Σ (r + 1) 3^i
//   two        up to 2        22 bytes, 3 residuals each: Σ (r + 2) 5^i
//   seven      up to 7        32 bytes, 2 residuals each: (r + 7) + 15 (r + 7)
//   byte       up to 127      64 bytes (-128 too)
//   word       any            64 low bytes, then 64 high ones, folded: 0, -1, 1, -2 … as 0, 1, 2, 3 …
//
// The last byte of `one` and `two` is filled up with residuals of 0.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "imev/tile.hpp"

namespace nutik::tik {

enum class Reach : std::uint8_t { none, one, two, seven, byte, word };
inline constexpr std::size_t kReaches = 6;
inline constexpr std::array<std::size_t, kReaches> kPackedBytes{0, 13, 22, 32, 64, 128};

using Residuals = std::array<std::int16_t, kTilePixels>;

[[nodiscard]] inline Reach reach_of(const Residuals& residuals) {
  std::int16_t low = 0, high = 0;
  for (const std::int16_t residual : residuals) {
    low = std::min(low, residual);
    high = std::max(high, residual);
  }
  const int reach = std::max(-static_cast<int>(low), static_cast<int>(high));
  if (reach == 0) return Reach::none;
  if (reach <= 1) return Reach::one;
  if (reach <= 2) return Reach::two;
  if (reach <= 7) return Reach::seven;
  return low >= -128 && high <= 127 ? Reach::byte : Reach::word;
}

namespace packing {

// `PerByte` digits of base `Base` in a byte, each a residual + Base / 2.
template <int Base, int PerByte>
struct Digits {
  static constexpr std::size_t kBytes = (kTilePixels + PerByte - 1) / PerByte;
  // The first PerByte are a byte's, and 0 behind them: a vector, written whole.
  using Group = std::array<std::int16_t, 8>;

  // Bytes that no packing makes give residuals of 0.
  static constexpr std::array<Group, 256> make_table() {
    std::array<Group, 256> table{};
    int limit = 1;
    for (int i = 0; i < PerByte; ++i) limit *= Base;
    for (int byte = 0; byte < limit; ++byte) {
      int rest = byte;
      for (std::size_t i = 0; i < PerByte; ++i, rest /= Base) {
        table[static_cast<std::size_t>(byte)][i] = static_cast<std::int16_t>(rest % Base - Base / 2);
      }
    }
    return table;
  }

  static void pack(const Residuals& residuals, std::byte* to) {
    for (std::size_t b = 0; b < kBytes; ++b) {
      int value = 0;
      for (std::size_t i = PerByte; i-- > 0;) {
        const std::size_t lane = b * PerByte + i;
        value = value * Base + (lane < kTilePixels ? residuals[lane] : 0) + Base / 2;
      }
      to[b] = static_cast<std::byte>(value);
    }
  }

  static void unpack(const std::byte* from, Residuals& residuals) {
    static constexpr std::array<Group, 256> kTable = make_table();
    std::array<std::int16_t, (kBytes - 1) * PerByte + sizeof(Group) / sizeof(std::int16_t)> digits;
    for (std::size_t b = 0; b < kBytes; ++b) {
      const Group& group = kTable[static_cast<std::size_t>(from[b])];
      std::memcpy(digits.data() + b * PerByte, group.data(), sizeof group);
    }
    std::memcpy(residuals.data(), digits.data(), sizeof residuals);
  }
};

}  // namespace packing

// Writes kPackedBytes of the reach, which must be the residuals' own or a farther one.
inline void pack_residuals(const Residuals& residuals, Reach reach, std::byte* to) {
  switch (reach) {
    case Reach::none: break;
    case Reach::one: packing::Digits<3, 5>::pack(residuals, to); break;
    case Reach::two: packing::Digits<5, 3>::pack(residuals, to); break;
    case Reach::seven: packing::Digits<15, 2>::pack(residuals, to); break;
    case Reach::byte:
      for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
        to[lane] = static_cast<std::byte>(residuals[lane] & 0xFF);
      }
      break;
    case Reach::word:
      for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
        const int folded = residuals[lane] * 2 ^ (residuals[lane] < 0 ? -1 : 0);
        to[lane] = static_cast<std::byte>(folded & 0xFF);
        to[kTilePixels + lane] = static_cast<std::byte>(folded >> 8 & 0xFF);
      }
      break;
  }
}

inline void unpack_residuals(const std::byte* from, Reach reach, Residuals& residuals) {
  switch (reach) {
    case Reach::none: residuals.fill(0); break;
    case Reach::one: packing::Digits<3, 5>::unpack(from, residuals); break;
    case Reach::two: packing::Digits<5, 3>::unpack(from, residuals); break;
    case Reach::seven: packing::Digits<15, 2>::unpack(from, residuals); break;
    case Reach::byte:
      for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
        residuals[lane] = static_cast<std::int8_t>(from[lane]);
      }
      break;
    case Reach::word:
      for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
        const int folded = static_cast<int>(from[lane]) | static_cast<int>(from[kTilePixels + lane]) << 8;
        residuals[lane] = static_cast<std::int16_t>(folded >> 1 ^ -(folded & 1));
      }
      break;
  }
}

}  // namespace nutik::tik
