// What the open block says of each tile so far: a row of codes for every sample at which anything in the tile
// changed, and how many change records they come to. From it each tile is stored the cheapest way.
//
//   in:      rows, in time order within each tile; the first at the block's first sample
//   out:     a block's payload (layout: imev/block.hpp), built where it lies: rows stay where they are written,
//            unless records replace them
//   always:  memory follows the rows that there are. A tile has a room for so many rows, with the list of their
//            samples in front of them:
//
//       directory │ list, rows of tile 0 │ … of tile 1 │ … of tile 2 │ …  │ … of tile 1 in a larger room │ …
//
//            At first rooms take as many rows as their tiles had in the block before, and some more. A tile that
//            needs more moves to a room where others have just left, or behind all of them. It takes as many rows
//            as the tile will have if it goes on like this until the block ends, but no more than twice as many as
//            the old one unless the tile has changed with every sample so far
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/picture.hpp"
#include "imev/block.hpp"
#include "imev/tile_cost.hpp"
#include "imev/tile_step.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

// The most bytes that a tile of such a block may come to.
[[nodiscard]] std::uint64_t largest_body_bytes(const BlockGeometry& geometry, TilePolicy policy);

// How far a block has come, with the samples that are being added, and how far it may come.
struct BlockCourse {
  std::uint32_t samples;
  std::uint32_t expected_samples;
};

class TileLog {
 public:
  // A block has at most `block_samples`. From half of `memory_bytes` on, rooms are no larger than their rows.
  TileLog(const CaptureFormat& capture, std::uint32_t block_samples, TilePolicy policy,
          std::uint64_t memory_bytes = ~std::uint64_t{0});

  // What the block takes so far.
  [[nodiscard]] std::uint64_t bytes() const { return end_; }

  // A tile's last row, codes [C][64]; there is none before the block's first sample.
  [[nodiscard]] const std::byte* last_row(std::uint64_t tile) const {
    const Tile& at = tiles_[tile];
    return payload_.data() + at.offset + (at.rows - 1) * full_.row_bytes();
  }
  // Where the codes of its next rows belong, one behind the other, while its room takes them.
  [[nodiscard]] std::byte* next_row(std::uint64_t tile) {
    const Tile& at = tiles_[tile];
    return payload_.data() + at.offset + at.rows * full_.row_bytes();
  }
  [[nodiscard]] bool has_room(std::uint64_t tile, std::uint32_t rows) const {
    return tiles_[tile].rows + rows <= tiles_[tile].room;
  }
  // Fetches where the samples of a tile's next rows will be listed, which is far from its rows.
  void fetch_list(std::uint64_t tile) { __builtin_prefetch(list(tiles_[tile]) + tiles_[tile].rows, 1); }
  // Makes room for so many rows more. All rows may move.
  void make_room(std::uint64_t tile, std::uint32_t rows, BlockCourse course);

  // Takes the next rows, which are where they belong: at these samples, with so many change records in all. Different
  // tiles may be given theirs side by side.
  void add_rows(std::uint64_t tile, std::span<const std::uint16_t> samples, std::uint32_t changes) {
    Tile& at = tiles_[tile];
    at.changes += changes;
    if (at.room == 1) {
      at.rows = 1;
      return;
    }
    std::uint16_t* listed = list(at);
    for (const std::uint16_t sample : samples) listed[at.rows++] = sample;
  }

  // Begins a block. Each tile has a room for as many rows as it had in the block before and some more, and for one at
  // least.
  void begin();
  // The same with rooms for as many rows as a block may have samples: none has to move.
  void begin_full();

  // Closes it with so many samples: `into` is given the payload's memory, and its own is used for the next block.
  FinishedBlock finish(std::uint32_t samples, PageBuffer& into);
  // Memory to be used for the next block.
  void take_memory(PageBuffer memory) { payload_ = std::move(memory); }

 private:
  struct Tile {
    std::uint64_t offset = 0;   // of its first row in the payload; its list ends there
    std::uint32_t room = 0;     // rows
    std::uint32_t rows = 0;     // so far
    std::uint32_t changes = 0;  // change records of its pixels together
  };

  // What the list in front of a room's rows takes: a sample number of two bytes each while the block is open. A
  // single row needs none.
  static std::uint64_t list_bytes(std::uint32_t room) {
    return room <= 1 ? 0 : align_up(std::uint64_t{room} * sizeof(std::uint16_t), kBlockAlignment);
  }
  [[nodiscard]] std::uint16_t* list(const Tile& at) {
    return reinterpret_cast<std::uint16_t*>(payload_.data() + at.offset - list_bytes(at.room));
  }
  [[nodiscard]] std::uint64_t room_bytes(std::uint32_t room) const {
    return list_bytes(room) + room * full_.row_bytes();
  }

  [[nodiscard]] std::uint32_t first_room(std::uint32_t rows) const;
  void begin_tile(Tile& tile);
  [[nodiscard]] TileEntry choose(const BlockGeometry& geometry, const Tile& tile) const;
  [[nodiscard]] std::uint32_t slots(const Tile& tile) const;
  // These tell where the tile's body begins.
  std::uint64_t close_rows(const BlockGeometry& geometry, const Tile& tile);
  std::uint64_t close_records(const BlockGeometry& geometry, const Tile& tile, std::uint32_t slots);
  std::uint64_t append(std::uint64_t bytes);
  void leave(const Tile& room);

  BlockGeometry full_;  // of a full block
  TilePolicy policy_;
  std::uint64_t tight_from_;  // bytes
  DifferFunction differ_;
  PageBuffer payload_;
  std::uint64_t end_ = 0;  // of the last room in it
  // Rooms side by side that tiles have left, the last ones to do so. What fits there need not be behind all others.
  struct {
    std::uint64_t begin = 0, end = 0;
  } left_;
  std::vector<Tile> tiles_;
  std::vector<std::uint16_t> samples_;  // of a tile that is being closed, by row
  std::vector<std::byte> rows_;         // of one that is being stored as records
};

}  // namespace nutik
