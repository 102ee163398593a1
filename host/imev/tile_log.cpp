#include "imev/tile_log.hpp"

#include <algorithm>
#include <array>
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
      payload_(full_.directory_bytes() + full_.tile_count * tile_room_),
      changed_(full_.tile_count * block_samples * sizeof(std::uint64_t)),
      row_sample_(full_.tile_count * block_samples * sizeof(std::uint16_t)),
      row_count_(full_.tile_count),
      lane_records_(full_.tile_count * kTilePixels) {}

std::byte* TileLog::add_row(std::uint64_t tile, std::uint32_t sample, std::uint64_t changes) {
  const std::uint32_t row = row_count_[tile]++;
  const std::uint64_t slot = slot_of(tile, row);
  reinterpret_cast<std::uint16_t*>(row_sample_.data())[slot] = static_cast<std::uint16_t>(sample);
  reinterpret_cast<std::uint64_t*>(changed_.data())[slot] = changes;
  return payload_.data() + rows_offset(tile) + row * full_.row_bytes();
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
  finished.record_count = std::accumulate(lane_records_.begin(), lane_records_.end(), std::uint64_t{0});
  std::swap(payload_, into);
  payload_.reserve(full_.directory_bytes() + full_.tile_count * tile_room_);
  return finished;
}

void TileLog::clear() {
  std::fill(row_count_.begin(), row_count_.end(), 0);
  std::fill(lane_records_.begin(), lane_records_.end(), 0);
}

TileEntry TileLog::choose(const BlockGeometry& geometry, std::uint64_t tile) const {
  const std::uint16_t* counts = lane_records_.data() + tile * kTilePixels;
  const std::uint32_t slots = *std::max_element(counts, counts + kTilePixels);
  const std::uint32_t rows = row_count_[tile];
  const bool as_records = policy_ == TilePolicy::records ||
                          (policy_ == TilePolicy::automatic && records_are_cheaper(geometry, rows, slots));
  return {0, as_records ? slots | TileEntry::kRecordsFlag : rows};
}

// Puts the list of the rows' samples right before them.
void TileLog::close_rows(const BlockGeometry& geometry, std::uint64_t tile, TileEntry& entry) {
  const std::uint64_t index_bytes = geometry.row_index_bytes(entry.rows());
  const std::uint64_t offset = rows_offset(tile) - index_bytes;
  entry.offset = static_cast<std::uint32_t>(offset / kBlockAlignment);
  if (index_bytes == 0) return;
  std::byte* list = payload_.data() + offset;
  std::memset(list, 0, index_bytes);
  for (std::uint32_t row = 0; row < entry.rows(); ++row)
    write_index(geometry, list, row, row_samples(tile)[row]);
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
    for (std::uint64_t lanes = row_changes(tile)[row]; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctzll(lanes));
      std::byte* index = body + row_bytes + filled[lane]++ * slot_bytes;
      write_index(geometry, index, lane, row_samples(tile)[row]);
      for (std::uint32_t channel = 0; channel < geometry.channels; ++channel) {
        const std::size_t at = (channel * kTilePixels + lane) * geometry.code_bytes;
        std::memcpy(index + index_bytes + at, codes + at, geometry.code_bytes);
      }
    }
  }
}

}  // namespace nutik
