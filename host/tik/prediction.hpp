// Prediction: turns tile bodies into residuals that a general compressor packs well, and back. Lossless.
//
// The codes of a group of consecutive tiles become one plain stream (b = bytes of a code, n = rows or,
// with the start, slots + 1 of a tile):
//
//   indices     for each tile with an index: the list's differences from one entry to the next, rows
//               tiles [rows], records tiles [slots][64]; index width as in the block
//   modes       for each tile, for each of its n rows, one byte: how the row is predicted
//                 0  from the row before (a slot: from the slot before)
//                 1  from the neighbours left, above and left above in the same row (the median of left,
//                    above, and left + above - left above); the first pixel from the row before
//   residuals   for each channel, for each byte of a code (low first), for each tile, for each of its
//               rows: [64]
//
// Colours are decorrelated first: green, red - green + half, blue - green + half, modulo 2^(8b).
// Residuals are differences modulo 2^(8b); those of two bytes are folded so that small ones of either
// sign have a high byte of 0: 0, -1, 1, -2, 2 … become 0, 1, 2, 3, 4 …
//
// Before the first row of a tile all codes count as 0; a first row is always of mode 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "imev/block.hpp"

namespace nutik::tik {

// Consecutive tiles of a payload.
struct TileGroup {
  std::span<const TileEntry> entries;
  const BlockGeometry& geometry;

  // Bytes of the plain stream.
  [[nodiscard]] std::uint64_t plain_bytes() const;
};

// Writes plain_bytes() bytes from the tiles' bodies in `payload`.
void predict(const TileGroup& group, std::span<const std::byte> payload, std::span<std::byte> plain);

// Writes the tiles' bodies into `payload` again. Returns false where the stream cannot be one that
// predict() wrote.
[[nodiscard]] bool reconstruct(const TileGroup& group, std::span<const std::byte> plain,
                               std::span<std::byte> payload);

}  // namespace nutik::tik
