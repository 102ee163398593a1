// What the open block says of each tile so far: a row of codes for every sample at which anything in the tile
// changed, and how many change records they come to. From it each tile is stored the cheapest way.
//
//   in:      rows, in time order within each tile; the first at the block's first sample
//   out:     a block's payload (layout: imev/block.hpp), built where it lies: rows stay where they are written,
//            unless records replace them
//   always:  room for the largest body of every tile in address space; only what is used is ever touched.
//            Different tiles may be written side by side
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "capture/picture.hpp"
#include "imev/block.hpp"
#include "imev/tile_cost.hpp"
#include "imev/tile_step.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

// The most bytes that a tile of such a block may come to.
[[nodiscard]] std::uint64_t largest_body_bytes(const BlockGeometry& geometry, TilePolicy policy);

class TileLog {
 public:
  TileLog(const CaptureFormat& capture, std::uint32_t block_samples, TilePolicy policy);

  // A tile's last row, codes [C][64]; there is none before the block's first sample.
  [[nodiscard]] const std::byte* last_row(std::uint64_t tile) const {
    return payload_.data() + rows_offset(tile) + (row_count_[tile] - 1) * full_.row_bytes();
  }
  // Where the codes of its next rows belong, one behind the other.
  [[nodiscard]] std::byte* next_row(std::uint64_t tile) {
    return payload_.data() + rows_offset(tile) + row_count_[tile] * full_.row_bytes();
  }
  // Takes the next of these, of which `changes` are the lanes, as bits, that differ from the row before (none at
  // the block's first sample).
  void add_row(std::uint64_t tile, std::uint32_t sample, std::uint64_t changes) {
    samples(tile)[row_count_[tile]++] = static_cast<std::uint16_t>(sample);
    change_count_[tile] += static_cast<std::uint32_t>(std::popcount(changes));
  }

  // Begins a block.
  void begin();
  // Closes it with so many samples: `into` is given the payload's memory, and its own is used for the next block.
  FinishedBlock finish(std::uint32_t samples, PageBuffer& into);
  // Memory to be used for the next block.
  void take_memory(PageBuffer memory) { payload_ = std::move(memory); }

 private:
  [[nodiscard]] TileEntry choose(const BlockGeometry& geometry, std::uint64_t tile) const;
  [[nodiscard]] std::uint32_t slots(std::uint64_t tile) const;
  void close_rows(const BlockGeometry& geometry, std::uint64_t tile, TileEntry& entry);
  void close_records(const BlockGeometry& geometry, std::uint64_t tile, TileEntry& entry);

  // Where a tile's rows lie in the payload; the room before them takes the largest list of their samples.
  [[nodiscard]] std::uint64_t rows_offset(std::uint64_t tile) const {
    return full_.directory_bytes() + tile * tile_room_ + index_room_;
  }
  // Of each of its rows, within the block.
  [[nodiscard]] std::uint16_t* samples(std::uint64_t tile) {
    return reinterpret_cast<std::uint16_t*>(samples_.data()) + tile * full_.sample_count;
  }

  BlockGeometry full_;  // of a full block
  TilePolicy policy_;
  std::uint64_t index_room_;  // bytes
  std::uint64_t tile_room_;   // bytes
  DifferFunction differ_;
  PageBuffer payload_;                       // directory; [tile] index list, [row][C][64] codes
  PageBuffer samples_;                       // [tile][sample_count]
  std::vector<std::uint32_t> row_count_;     // [tile]
  std::vector<std::uint32_t> change_count_;  // [tile] change records of its pixels together
  std::vector<std::byte> rows_;              // of a tile that is being stored as records
};

}  // namespace nutik
