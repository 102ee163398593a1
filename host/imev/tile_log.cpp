#include "imev/tile_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>

namespace nutik {
namespace {

void write_index(const BlockGeometry& geometry, std::byte* list, std::uint64_t position,
                 std::uint32_t sample) {
  if (geometry.index_bytes() == 1) {
    list[position] = static_cast<std::byte>(sample);
  } else {
    const auto wide = static_cast<std::uint16_t>(sample);
    std::memcpy(list + position * 2, &wide, sizeof wide);
  }
}

std::uint64_t largest_index_bytes(const BlockGeometry& geometry) {
  return align_up(std::uint64_t{geometry.sample_count} * geometry.index_bytes(), kBlockAlignment);
}

}  // namespace

std::uint64_t largest_body_bytes(const BlockGeometry& geometry, TilePolicy policy) {
  const std::uint64_t rows = largest_index_bytes(geometry) + geometry.sample_count * geometry.row_bytes();
  // Chosen for their cost, records take fewer bytes than the rows would.
  if (policy != TilePolicy::records) return rows;
  return std::max(rows, geometry.records_bytes(geometry.sample_count - 1));
}

TileLog::TileLog(const CaptureFormat& capture, std::uint32_t block_samples, TilePolicy policy)
    : full_(capture, block_samples),
      policy_(policy),
      index_room_(largest_index_bytes(full_)),
      tile_room_(largest_body_bytes(full_, policy)),
      differ_(differ_function(full_.channels, full_.code_bytes)),
      samples_(full_.tile_count * block_samples * sizeof(std::uint16_t)),
      row_count_(full_.tile_count),
      change_count_(full_.tile_count) {}

void TileLog::begin() {
  payload_.reserve(full_.directory_bytes() + full_.tile_count * tile_room_);
  std::fill(row_count_.begin(), row_count_.end(), 0);
  std::fill(change_count_.begin(), change_count_.end(), 0);
}

FinishedBlock TileLog::finish(std::uint32_t samples, PageBuffer& into) {
  BlockGeometry geometry = full_;
  geometry.sample_count = samples;
  FinishedBlock finished;
  finished.payload_bytes = geometry.directory_bytes();
  std::vector<TileEntry> entries(geometry.tile_count);
  for (std::uint64_t tile = 0; tile < entries.size(); ++tile) {
    TileEntry& entry = entries[tile];
    entry = choose(geometry, tile);
    if (entry.is_records()) {
      close_records(geometry, tile, entry);
    } else {
      close_rows(geometry, tile, entry);
    }
    finished.payload_bytes += geometry.body_bytes(entry);
    finished.span_bytes = entry.offset * kBlockAlignment + geometry.body_bytes(entry);
  }
  std::memset(payload_.data(), 0, geometry.directory_bytes());
  std::memcpy(payload_.data(), entries.data(), entries.size() * sizeof(TileEntry));
  finished.record_count = std::accumulate(change_count_.begin(), change_count_.end(), std::uint64_t{0});
  std::swap(payload_, into);
  return finished;
}

TileEntry TileLog::choose(const BlockGeometry& geometry, std::uint64_t tile) const {
  const std::uint32_t rows = row_count_[tile];
  const TileEntry as_rows{0, rows};
  // The busiest pixel has no fewer changes than all of them have on average: rows are read again only where
  // records may be worth it.
  const std::uint32_t fewest_slots = (change_count_[tile] + kTilePixels - 1) / kTilePixels;
  const bool is_free = policy_ == TilePolicy::automatic;
  if (policy_ != TilePolicy::records && !(is_free && records_are_cheaper(geometry, rows, fewest_slots)))
    return as_rows;
  const std::uint32_t slot_count = slots(tile);
  if (is_free && !records_are_cheaper(geometry, rows, slot_count)) return as_rows;
  return {0, slot_count | TileEntry::kRecordsFlag};
}

// The change records of a tile's busiest pixel.
std::uint32_t TileLog::slots(std::uint64_t tile) const {
  std::array<std::uint32_t, kTilePixels> counts{};
  const std::byte* row = payload_.data() + rows_offset(tile);
  for (std::uint32_t r = 1; r < row_count_[tile]; ++r, row += full_.row_bytes()) {
    for (std::uint64_t lanes = differ_(row, row + full_.row_bytes()); lanes != 0; lanes &= lanes - 1) {
      ++counts[static_cast<std::uint32_t>(std::countr_zero(lanes))];
    }
  }
  return *std::max_element(counts.begin(), counts.end());
}

// Puts the list of the rows' samples right before them.
void TileLog::close_rows(const BlockGeometry& geometry, std::uint64_t tile, TileEntry& entry) {
  const std::uint64_t index_bytes = geometry.row_index_bytes(entry.rows());
  const std::uint64_t offset = rows_offset(tile) - index_bytes;
  entry.offset = static_cast<std::uint32_t>(offset / kBlockAlignment);
  if (index_bytes == 0) return;
  std::byte* list = payload_.data() + offset;
  std::memset(list, 0, index_bytes);
  for (std::uint32_t row = 0; row < entry.rows(); ++row) write_index(geometry, list, row, samples(tile)[row]);
}

// Puts records where the rows were.
void TileLog::close_records(const BlockGeometry& geometry, std::uint64_t tile, TileEntry& entry) {
  const std::uint64_t row_bytes = geometry.row_bytes();
  const std::uint64_t slot_bytes = geometry.slot_bytes();
  const std::uint64_t index_bytes = kTilePixels * geometry.index_bytes();
  const std::uint32_t rows = row_count_[tile], slots = entry.slots();
  const std::uint64_t offset = rows_offset(tile) - index_room_;
  entry.offset = static_cast<std::uint32_t>(offset / kBlockAlignment);
  std::byte* body = payload_.data() + offset;
  const std::byte* first_row = body + index_room_;
  rows_.assign(first_row, first_row + rows * row_bytes);

  std::memcpy(body, rows_.data(), row_bytes);
  // Padding first: every slot ends as "the last codes, at no sample of the block".
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    std::byte* index = body + row_bytes + slot * slot_bytes;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      write_index(geometry, index, lane, geometry.sample_count);
    }
    std::memcpy(index + index_bytes, rows_.data() + (rows - 1) * row_bytes, row_bytes);
  }
  std::array<std::uint16_t, kTilePixels> filled{};
  for (std::uint32_t row = 1; row < rows; ++row) {
    const std::byte* codes = rows_.data() + row * row_bytes;
    for (std::uint64_t lanes = differ_(codes - row_bytes, codes); lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      std::byte* index = body + row_bytes + filled[lane]++ * slot_bytes;
      write_index(geometry, index, lane, samples(tile)[row]);
      for (std::uint32_t channel = 0; channel < geometry.channels; ++channel) {
        const std::size_t at = (channel * kTilePixels + lane) * geometry.code_bytes;
        std::memcpy(index + index_bytes + at, codes + at, geometry.code_bytes);
      }
    }
  }
}

}  // namespace nutik
