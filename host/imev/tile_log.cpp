#include "imev/tile_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <new>
#include <utility>

#include "imev/block_builder.hpp"

namespace nutik {
namespace {

// At first a room takes a quarter more rows than its tile had in the block before.
constexpr std::uint32_t kSpareShare = 4;

// Lists lie far from each other: while a tile is closed, that of a later one is fetched.
constexpr std::uint64_t kAhead = 8;

void write_index(const BlockGeometry& geometry, std::byte* list, std::uint64_t position,
                 std::uint32_t sample) {
  if (geometry.index_bytes() == 1) {
    list[position] = static_cast<std::byte>(sample);
  } else {
    const auto wide = static_cast<std::uint16_t>(sample);
    std::memcpy(list + position * 2, &wide, sizeof wide);
  }
}

}  // namespace

std::uint64_t largest_body_bytes(const BlockGeometry& geometry, TilePolicy policy) {
  const std::uint64_t rows =
      align_up(std::uint64_t{geometry.sample_count} * geometry.index_bytes(), kBlockAlignment) +
      geometry.sample_count * geometry.row_bytes();
  // Chosen for their cost, records take fewer bytes than the rows would.
  if (policy != TilePolicy::records) return rows;
  return std::max(rows, geometry.records_bytes(geometry.sample_count - 1));
}

TileLog::TileLog(const CaptureFormat& capture, std::uint32_t block_samples, TilePolicy policy,
                 std::uint64_t memory_bytes)
    : full_(capture, block_samples),
      policy_(policy),
      tight_from_(memory_bytes / 2),
      differ_(differ_function(full_.channels, full_.code_bytes)),
      tiles_(full_.tile_count) {}

// Rows to begin a tile with that had so many in the block before. Where that block ended is a matter of what changed in
// it: if the next one ends a little later, not all its tiles should have to move.
std::uint32_t TileLog::first_room(std::uint32_t rows) const {
  return std::min(std::max(rows + rows / kSpareShare, 1u), full_.sample_count);
}

void TileLog::begin() {
  left_ = {};
  end_ = full_.directory_bytes();
  std::uint64_t as_before = end_;
  for (const Tile& tile : tiles_) as_before += room_bytes(first_room(tile.rows));
  const bool is_tight = as_before >= tight_from_;
  for (Tile& tile : tiles_) {
    tile.room = is_tight ? 1 : first_room(tile.rows);
    begin_tile(tile);
  }
  // Address space: more than this is rarely needed, and only what is used is ever touched.
  payload_.grow(2 * end_);
}

void TileLog::begin_full() {
  left_ = {};
  end_ = full_.directory_bytes();
  for (Tile& tile : tiles_) {
    tile.room = full_.sample_count;
    begin_tile(tile);
  }
  payload_.grow(end_);
}

void TileLog::begin_tile(Tile& tile) {
  tile.offset = end_ + list_bytes(tile.room);
  tile.rows = tile.changes = 0;
  end_ += room_bytes(tile.room);
}

// Room for so many bytes where tiles have left, or behind all others; tells where.
std::uint64_t TileLog::append(std::uint64_t bytes) {
  bytes = align_up(bytes, kBlockAlignment);
  if (bytes <= left_.end - left_.begin) return std::exchange(left_.begin, left_.begin + bytes);
  const std::uint64_t offset = end_;
  end_ += bytes;
  if (end_ > kLargestPayloadBytes) throw std::bad_alloc();  // no tile's offset reaches beyond
  if (end_ > payload_.size()) payload_.grow(end_ + end_ / 2);
  return offset;
}

void TileLog::leave(const Tile& room) {
  const std::uint64_t begin = room.offset - list_bytes(room.room);
  if (begin != left_.end) left_.begin = begin;
  left_.end = begin + room_bytes(room.room);
}

void TileLog::make_room(std::uint64_t tile, std::uint32_t rows, BlockCourse course) {
  Tile& at = tiles_[tile];
  const std::uint32_t needed = at.rows + rows;
  // As many as there will be if the tile goes on like this: one that changes now and then may well not.
  const std::uint32_t expected = static_cast<std::uint32_t>(
      (std::uint64_t{needed} * course.expected_samples + course.samples - 1) / course.samples);
  const bool is_tight = end_ >= tight_from_, is_busy = needed == course.samples;
  const std::uint32_t wanted = is_tight ? needed : is_busy ? expected : std::min(2 * at.room, expected);
  Tile moved = at;
  moved.room = std::min(std::max(needed, wanted), std::max(needed, full_.sample_count));
  moved.offset = append(room_bytes(moved.room)) + list_bytes(moved.room);
  std::memcpy(payload_.data() + moved.offset, payload_.data() + at.offset, at.rows * full_.row_bytes());
  if (at.room > 1) {
    std::memcpy(list(moved), list(at), at.rows * sizeof(std::uint16_t));
  } else {
    list(moved)[0] = 0;
  }
  leave(at);
  at = moved;
}

FinishedBlock TileLog::finish(std::uint32_t samples, PageBuffer& into) {
  BlockGeometry geometry = full_;
  geometry.sample_count = samples;
  FinishedBlock finished;
  finished.payload_bytes = geometry.directory_bytes();
  std::vector<TileEntry> entries(geometry.tile_count);
  for (std::uint64_t i = 0; i < entries.size(); ++i) {
    if (i + kAhead < entries.size()) __builtin_prefetch(list(tiles_[i + kAhead]));
    const Tile& tile = tiles_[i];
    TileEntry& entry = entries[i];
    entry = choose(geometry, tile);
    const std::uint64_t offset =
        entry.is_records() ? close_records(geometry, tile, entry.slots()) : close_rows(geometry, tile);
    entry.offset = static_cast<std::uint32_t>(offset / kBlockAlignment);
    finished.payload_bytes += geometry.body_bytes(entry);
    finished.record_count += tile.changes;
  }
  finished.span_bytes = end_;
  std::memset(payload_.data(), 0, geometry.directory_bytes());
  std::memcpy(payload_.data(), entries.data(), entries.size() * sizeof(TileEntry));
  std::swap(payload_, into);
  return finished;
}

TileEntry TileLog::choose(const BlockGeometry& geometry, const Tile& tile) const {
  const TileEntry as_rows{0, tile.rows};
  // The busiest pixel has no fewer changes than all of them have on average: rows are read again only where
  // records may be worth it.
  const std::uint32_t fewest_slots = (tile.changes + kTilePixels - 1) / kTilePixels;
  const bool is_free = policy_ == TilePolicy::automatic;
  if (policy_ != TilePolicy::records && !(is_free && records_are_cheaper(geometry, tile.rows, fewest_slots)))
    return as_rows;
  const std::uint32_t slot_count = slots(tile);
  if (is_free && !records_are_cheaper(geometry, tile.rows, slot_count)) return as_rows;
  return {0, slot_count | TileEntry::kRecordsFlag};
}

// The change records of a tile's busiest pixel.
std::uint32_t TileLog::slots(const Tile& tile) const {
  std::array<std::uint32_t, kTilePixels> counts{};
  const std::byte* row = payload_.data() + tile.offset;
  for (std::uint32_t r = 1; r < tile.rows; ++r, row += full_.row_bytes()) {
    for (std::uint64_t lanes = differ_(row, row + full_.row_bytes()); lanes != 0; lanes &= lanes - 1) {
      ++counts[static_cast<std::uint32_t>(std::countr_zero(lanes))];
    }
  }
  return *std::max_element(counts.begin(), counts.end());
}

// Puts the list of the rows' samples right before them, as wide as the block needs it.
std::uint64_t TileLog::close_rows(const BlockGeometry& geometry, const Tile& tile) {
  const std::uint64_t index_bytes = geometry.row_index_bytes(tile.rows);
  if (index_bytes == 0) return tile.offset;
  samples_.assign(list(tile), list(tile) + tile.rows);
  std::byte* index = payload_.data() + tile.offset - index_bytes;
  std::memset(index, 0, index_bytes);
  for (std::uint32_t row = 0; row < tile.rows; ++row) write_index(geometry, index, row, samples_[row]);
  return tile.offset - index_bytes;
}

// Puts records where the rows were, or where there is room for them.
std::uint64_t TileLog::close_records(const BlockGeometry& geometry, const Tile& tile, std::uint32_t slots) {
  const std::uint64_t row_bytes = geometry.row_bytes();
  const std::uint64_t slot_bytes = geometry.slot_bytes();
  const std::uint64_t index_bytes = kTilePixels * geometry.index_bytes();
  const std::byte* first_row = payload_.data() + tile.offset;
  rows_.assign(first_row, first_row + tile.rows * row_bytes);
  samples_.assign(1, 0);
  if (tile.rows > 1) samples_.assign(list(tile), list(tile) + tile.rows);

  const std::uint64_t body_bytes = geometry.records_bytes(slots);
  const std::uint64_t offset =
      body_bytes <= room_bytes(tile.room) ? tile.offset - list_bytes(tile.room) : append(body_bytes);
  std::byte* body = payload_.data() + offset;
  std::memcpy(body, rows_.data(), row_bytes);
  // Padding first: every slot ends as "the last codes, at no sample of the block".
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    std::byte* index = body + row_bytes + slot * slot_bytes;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      write_index(geometry, index, lane, geometry.sample_count);
    }
    std::memcpy(index + index_bytes, rows_.data() + (tile.rows - 1) * row_bytes, row_bytes);
  }
  std::array<std::uint16_t, kTilePixels> filled{};
  for (std::uint32_t row = 1; row < tile.rows; ++row) {
    const std::byte* codes = rows_.data() + row * row_bytes;
    for (std::uint64_t lanes = differ_(codes - row_bytes, codes); lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      std::byte* index = body + row_bytes + filled[lane]++ * slot_bytes;
      write_index(geometry, index, lane, samples_[row]);
      for (std::uint32_t channel = 0; channel < geometry.channels; ++channel) {
        const std::size_t at = (channel * kTilePixels + lane) * geometry.code_bytes;
        std::memcpy(index + index_bytes + at, codes + at, geometry.code_bytes);
      }
    }
  }
  return offset;
}

}  // namespace nutik
