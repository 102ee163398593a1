// What the open block says of each tile so far: a row of codes for every sample at which anything in the tile
// changed, and which lanes did. From it each tile is stored the cheapest way.
//
//   in:      rows, in time order within each tile; the first at the block's first sample
//   out:     a block's payload (layout: imev/block.hpp)
//   always:  room for a row per sample and tile in address space; only rows that are used are ever touched.
//            Different tiles may be written side by side
#pragma once

#include <cstdint>
#include <vector>

#include "capture/picture.hpp"
#include "imev/block.hpp"
#include "imev/tile_cost.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

class TileLog {
 public:
  TileLog(const CaptureFormat& capture, std::uint32_t block_samples);

  // The next row of a tile, of which `changes` are the lanes, as bits, that changed (none at the block's
  // first sample). Returns where its codes [C][64] belong.
  std::byte* add_row(std::uint64_t tile, std::uint32_t sample, std::uint64_t changes);

  // Change records of each of a tile's lanes: whoever adds a row counts them.
  [[nodiscard]] std::uint16_t* counts(std::uint64_t tile) {
    return lane_records_.data() + tile * kTilePixels;
  }
  [[nodiscard]] std::uint64_t record_count() const;

  // Writes the payload of a block of `samples` to the front of `into`, which grows as needed; returns its
  // bytes.
  std::uint64_t write(std::uint32_t samples, TilePolicy policy, PageBuffer& into) const;

  // Begins the next block.
  void clear();

 private:
  [[nodiscard]] TileEntry choose(const BlockGeometry& geometry, std::uint64_t tile, TilePolicy policy) const;
  void write_rows(const BlockGeometry& geometry, std::uint64_t tile, std::uint32_t rows,
                  std::byte* body) const;
  void write_records(const BlockGeometry& geometry, std::uint64_t tile, std::uint32_t slots,
                     std::byte* body) const;

  [[nodiscard]] std::uint64_t slot_of(std::uint64_t tile, std::uint32_t row) const {
    return tile * full_.sample_count + row;
  }
  [[nodiscard]] const std::byte* row_at(std::uint64_t tile, std::uint32_t row) const {
    return rows_.data() + slot_of(tile, row) * full_.row_bytes();
  }
  [[nodiscard]] const std::uint16_t* row_samples(std::uint64_t tile) const {
    return reinterpret_cast<const std::uint16_t*>(row_sample_.data()) + slot_of(tile, 0);
  }
  [[nodiscard]] const std::uint64_t* row_changes(std::uint64_t tile) const {
    return reinterpret_cast<const std::uint64_t*>(changed_.data()) + slot_of(tile, 0);
  }

  BlockGeometry full_;                       // of a full block
  PageBuffer rows_;                          // [tile][sample_count][C][64] codes
  PageBuffer changed_;                       // [tile][sample_count] lanes that changed with the row, as bits
  PageBuffer row_sample_;                    // [tile][sample_count] sample of each row within the block
  std::vector<std::uint32_t> row_count_;     // [tile]
  std::vector<std::uint16_t> lane_records_;  // [tile][64] change records of each pixel in the block
};

}  // namespace nutik
