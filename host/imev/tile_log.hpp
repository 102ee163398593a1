// What the open block says of each tile so far: a row of codes for every sample at which anything in the tile
// changed, and which lanes did. From it each tile is stored the cheapest way.
//
//   in:      rows, in time order within each tile; the first at the block's first sample
//   out:     a block's payload (layout: imev/block.hpp), built where it lies: rows are written once
//   always:  room for the largest body of every tile in address space; only what is used is ever touched.
//            Different tiles may be written side by side
#pragma once

#include <cstdint>
#include <vector>

#include "capture/picture.hpp"
#include "imev/block.hpp"
#include "imev/tile_cost.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

// The most bytes that a tile of such a block may come to.
[[nodiscard]] std::uint64_t largest_body_bytes(const BlockGeometry& geometry, TilePolicy policy);

class TileLog {
 public:
  TileLog(const CaptureFormat& capture, std::uint32_t block_samples, TilePolicy policy);

  // The next row of a tile, of which `changes` are the lanes, as bits, that changed (none at the block's
  // first sample). Returns where its codes [C][64] belong.
  std::byte* add_row(std::uint64_t tile, std::uint32_t sample, std::uint64_t changes);

  // Change records of each of a tile's lanes: whoever adds a row counts them.
  [[nodiscard]] std::uint16_t* counts(std::uint64_t tile) {
    return lane_records_.data() + tile * kTilePixels;
  }

  // Closes a block of `samples`: `into` is given the payload's memory, and its own is used for the next block.
  // clear() must follow.
  FinishedBlock finish(std::uint32_t samples, PageBuffer& into);

  // Begins the next block.
  void clear();

 private:
  [[nodiscard]] TileEntry choose(const BlockGeometry& geometry, std::uint64_t tile) const;
  void close_rows(const BlockGeometry& geometry, std::uint64_t tile, TileEntry& entry);
  void close_records(const BlockGeometry& geometry, std::uint64_t tile, TileEntry& entry);

  [[nodiscard]] std::uint64_t slot_of(std::uint64_t tile, std::uint32_t row) const {
    return tile * full_.sample_count + row;
  }
  // Where a tile's rows lie in the payload; the room before them takes the largest list of their samples.
  [[nodiscard]] std::uint64_t rows_offset(std::uint64_t tile) const {
    return full_.directory_bytes() + tile * tile_room_ + index_room_;
  }
  [[nodiscard]] const std::uint16_t* row_samples(std::uint64_t tile) const {
    return reinterpret_cast<const std::uint16_t*>(row_sample_.data()) + slot_of(tile, 0);
  }
  [[nodiscard]] const std::uint64_t* row_changes(std::uint64_t tile) const {
    return reinterpret_cast<const std::uint64_t*>(changed_.data()) + slot_of(tile, 0);
  }

  BlockGeometry full_;  // of a full block
  TilePolicy policy_;
  std::uint64_t index_room_;                 // bytes
  std::uint64_t tile_room_;                  // bytes
  PageBuffer payload_;                       // directory; [tile] index list, [row][C][64] codes
  PageBuffer changed_;                       // [tile][sample_count] lanes that changed with the row, as bits
  PageBuffer row_sample_;                    // [tile][sample_count] sample of each row within the block
  std::vector<std::uint32_t> row_count_;     // [tile]
  std::vector<std::uint16_t> lane_records_;  // [tile][64] change records of each pixel in the block
  std::vector<std::byte> rows_;              // of a tile that is being stored as records
};

}  // namespace nutik
