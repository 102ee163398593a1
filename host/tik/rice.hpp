// Packs tiles by prediction and Rice codes, as quickly as memory is read, and unpacks them again. Lossless.
// docs/reference/tik-format.md specifies the form of a group of tiles; in short:
//
//   head      what a general compressor packs: sample numbers of rows, and two marks for each plane (64 codes of one
//             channel of one row, or the sample numbers of one slot): its shape (how many low bits, how many levels)
//             and how it is predicted
//   planes    the low bits of residuals: 64 bits each, the lanes' lowest bits, their next …
//   levels    what is left of residuals, in unary: which of 64 lanes are above 0, which of those above 1, …
//
// Nothing depends on what stands before it in a tile but the row before, and no lane on another but by sums, so that
// 64 lanes are packed and unpacked side by side. The instructions that are used make no difference to the bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tik/tile_rows.hpp"

namespace nutik::tik {

// How a plane is predicted. The values stand in files.
enum class RiceMode : std::uint8_t {
  before,  // by the row before
  above,   // by the pixel above, in the first line by the left one
  drift,   // by the row before, and what changed since then by the change above
  median   // of left, above, and left + above - left above, as tik/row_prediction.hpp does
};

inline constexpr unsigned kModeBits = 3;    // of a plane's second mark: RiceMode
inline constexpr unsigned kLeans = 4;       // green was subtracted from red or blue first
inline constexpr unsigned kTellsLines = 8;  // the lines in which any level is above 0 stand first
inline constexpr unsigned kInSteps = 16;    // codes moved by steps of the tolerance, which are counted (tile_step.hpp)

struct RiceMark {
  std::uint8_t shape;  // 16 × low bits + levels
  std::uint8_t how;
};

// Which instructions do it: those that every machine of a kind has, or the best of this one.
enum class Instructions { portable, best };

// Memory that groups are packed in, one after the other: new memory for each would have to be cleared by the system.
struct RiceRoom {
  std::uint64_t plane_count = 0;  // that there is room for
  std::unique_ptr<std::byte[]> planes, levels;
};

// The body, planes and then levels, lies in the room until the next group is packed there.
struct RiceGroup {
  std::vector<std::byte> head;
  std::span<const std::byte> planes, levels;
};

[[nodiscard]] RiceGroup encode_rice(const TileGroup& group, std::span<const std::byte> payload, RiceRoom& room,
                                    Instructions instructions = Instructions::best);

[[nodiscard]] std::uint64_t rice_head_bytes(const TileGroup& group);

// Writes the tiles' bodies into `payload` again; false where head and body belong to no such tiles. The head has
// rice_head_bytes().
[[nodiscard]] bool decode_rice(const TileGroup& group, std::span<const std::byte> head,
                               std::span<const std::byte> body, std::span<std::byte> payload,
                               Instructions instructions = Instructions::best);

}  // namespace nutik::tik
