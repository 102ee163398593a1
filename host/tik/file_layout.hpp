// The .tik container, version 1: what docs/reference/tik-format.md specifies.
//
//   ┌───────────────────────────────┐ 0
//   │ PGM or PPM of sample 0, with  │   opens in any image viewer; comments describe the capture
//   │ "# TIK" comments              │
//   ├───────────────────────────────┤ next multiple of 64, padded with zeros
//   │ fields (tik/fields.hpp)       │   from version 1 on
//   ├───────────────────────────────┤
//   │ block 0: BlockHeader          │
//   │          exposures (maybe)    │   each part at a multiple of 64
//   │          payload              │   imev/block.hpp, or packed by tik/codec.hpp
//   ├───────────────────────────────┤
//   │ block 1 …                     │
//   ├───────────────────────────────┤
//   │ index: IndexEntry per block   │
//   ├───────────────────────────────┤
//   │ exposures of all samples      │   irregular timelines only
//   ├───────────────────────────────┤
//   │ Footer                        │   the last 128 bytes
//   └───────────────────────────────┘
//
// Written from front to end without going back. All numbers little-endian; checksums are XXH3-64.
#pragma once

#include <cstddef>
#include <cstdint>

namespace nutik::tik {

inline constexpr std::uint32_t kVersion = 1;  // that is written; this one and those before it are read
inline constexpr std::uint64_t kAlignment = 64;

inline constexpr char kBlockMagic[8] = {'T', 'I', 'K', 'b', 'l', 'o', 'c', 'k'};
inline constexpr char kFooterMagic[8] = {'T', 'I', 'K', 'e', 'n', 'd', ' ', '0'};

enum class CodecId : std::uint32_t { none = 0, lz4 = 1, zstd = 2, rice = 3 };

struct BlockHeader {
  char magic[8];
  std::uint64_t block;  // number, from 0
  std::uint64_t first_sample;
  std::uint32_t sample_count;
  std::uint32_t codec;               // CodecId
  std::uint64_t exposure_bytes;      // sample_count × {start_ns, end_ns}; 0 with a constant rate
  std::uint64_t stored_bytes;        // of the payload in the file
  std::uint64_t payload_bytes;       // of the payload as the kernels read it
  std::uint64_t record_count;        // change records in the block, starts not counted
  std::uint64_t payload_checksum;    // of the stored payload
  std::uint64_t exposures_checksum;  // 0 with a constant rate
  std::uint64_t front_checksum;      // of the file's bytes before the first block
  std::uint8_t reserved[32];         // zeros
  std::uint64_t header_checksum;     // of the bytes before it
};
static_assert(sizeof(BlockHeader) == 128 && offsetof(BlockHeader, header_checksum) == 120);

struct IndexEntry {
  std::uint64_t offset;  // of the BlockHeader from the file's start
  std::uint64_t first_sample;
  std::uint32_t sample_count;
  std::uint32_t codec;
  std::uint64_t stored_bytes;
  std::uint64_t payload_bytes;
  std::uint64_t record_count;
};
static_assert(sizeof(IndexEntry) == 48);

struct Footer {
  std::uint64_t sample_count;
  std::uint64_t block_count;
  std::uint64_t index_offset;
  std::uint64_t exposures_offset;  // 0 with a constant rate
  std::int64_t duration_ns;
  std::uint64_t index_checksum;
  std::uint64_t exposures_checksum;
  std::uint64_t fields_offset;  // of fields that were known at the end only, 0 where there are none
  // The checksum of all block headers, one behind the other, so that nobody has to look for them all over a large file;
  // 0 in files of earlier programs.
  std::uint64_t headers_checksum;
  std::uint8_t reserved[40];  // zeros
  std::uint64_t checksum;     // of the bytes before it
  char magic[8];
};
static_assert(sizeof(Footer) == 128 && offsetof(Footer, checksum) == 112);

}  // namespace nutik::tik
