// Packs a block's payload for the file and unpacks it again, bit for bit.
//
// With codec `none` the payload is stored as it is and can be used straight from a mapped file. With
// the others it is stored as
//
//   u32 group count, u32 0
//   {u32 tile count, u32 packed bytes} for each group
//   u32 packed bytes of the tile counts, u32 0
//   the packed tile counts: TileEntry.count of every tile
//   the packed groups: consecutive tiles each. With `lz4` and `zstd` the packed sizes of head and parts (u32 each),
//   then those that are not empty, in the plain form of tik/prediction.hpp, each packed on its own; with `rice` the
//   packed bytes of the head (u32), the head, packed with zstd, and the body of tik/rice.hpp
//
// Offsets in the tile directory are not stored: bodies lie one behind the other. Groups are packed and
// unpacked side by side on all cores.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "imev/block.hpp"
#include "imev/block_lease.hpp"
#include "system/interruption.hpp"
#include "tik/file_layout.hpp"

namespace nutik::tik {

struct Codec {
  CodecId id = CodecId::none;
  int level = 0;  // zstd: 1 … 19; 0: the codec's usual one

  // `none`, `rice`, `lz4`, `zstd` or `zstd:9`; throws UsageError listing these.
  static Codec parse(std::string_view text);
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool is_slow() const { return id == CodecId::zstd && level >= 10; }
  friend bool operator==(const Codec&, const Codec&) = default;
};

// What captures are packed with where nothing is stated.
inline constexpr Codec kUsualCodec{CodecId::rice, 0};

// Makes `parts` the stored form of a payload, one behind the other, in the memory that they have; `geometry` is its
// block's. No more threads than these work on it. `progress` is called on any of them, one at a time: before each group
// of tiles, and by slow codecs with how many bytes they have packed. False, and parts that say nothing, where it takes
// as many bytes as `too_many`.
bool pack(const Codec& codec, const BlockGeometry& geometry, std::span<const std::byte> payload,
          std::vector<std::vector<std::byte>>& parts, std::uint32_t max_threads = ~std::uint32_t{0},
          const ReportedProgress& progress = {}, std::uint64_t too_many = ~std::uint64_t{0});

// Writes the payload, whose size the block's header tells; with `wants` only its directory and those groups of tiles
// of which any is wanted (imev/block_lease.hpp). Throws InputError where the stored form is damaged, as far as it was
// looked at.
void unpack(CodecId codec, const BlockGeometry& geometry, std::span<const std::byte> stored,
            std::span<std::byte> payload, const WantsTiles& wants = {});

// The payload's tile directory alone, without its bodies. Throws as unpack() does.
[[nodiscard]] std::vector<TileEntry> unpack_directory(CodecId codec, const BlockGeometry& geometry,
                                                      std::span<const std::byte> stored,
                                                      std::uint64_t payload_bytes);

}  // namespace nutik::tik
