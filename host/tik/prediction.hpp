// Prediction: turns tile bodies into residuals that a general compressor packs well, and back. Lossless.
// docs/reference/tik-format.md specifies the plain form of a group of consecutive tiles; in short:
//
//   head        the sample numbers of rows and records, each as the difference from the one before; then,
//               for each row of a tile (in records tiles the start and each slot), for each channel, a mark:
//               how it is predicted, and how far its residuals reach
//   parts       for each channel, for each reach: the rows of that reach, 64 residuals each, several in
//               one byte where they are small
//
// Colours are decorrelated first (green, red - green, blue - green). Sorting residuals by their reach and
// packing small ones together takes the compressor below one bit a residual, which its own symbol by
// symbol coding never reaches, and gives it a third of the bytes to work on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tik/residual_packing.hpp"
#include "tik/tile_rows.hpp"

namespace nutik::tik {

[[nodiscard]] std::uint64_t head_bytes(const TileGroup& group);

inline constexpr std::size_t kPlainParts = 3 * kReaches;  // [channel][reach]; grey uses the first third

struct PlainGroup {
  std::vector<std::byte> head;
  std::array<std::vector<std::byte>, kPlainParts> parts;
};

[[nodiscard]] PlainGroup predict(const TileGroup& group, std::span<const std::byte> payload);

// The sizes of the parts that belong to a head; nothing where the head cannot be one.
[[nodiscard]] std::optional<std::array<std::uint64_t, kPlainParts>> part_bytes(
    const TileGroup& group, std::span<const std::byte> head);

// Writes the tiles' bodies into `payload` again. The head's and parts' sizes must be as the functions
// above say.
void reconstruct(const TileGroup& group, const PlainGroup& plain, std::span<std::byte> payload);

}  // namespace nutik::tik
