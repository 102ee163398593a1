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

}  // namespace

TileLog::TileLog(const CaptureFormat& capture, std::uint32_t block_samples)
    : full_(capture, block_samples),
      rows_(full_.tile_count * block_samples * full_.row_bytes()),
      changed_(full_.tile_count * block_samples * sizeof(std::uint64_t)),
      row_sample_(full_.tile_count * block_samples * sizeof(std::uint16_t)),
      row_count_(full_.tile_count),
      lane_records_(full_.tile_count * kTilePixels) {}

std::byte* TileLog::add_row(std::uint64_t tile, std::uint32_t sample, std::uint64_t changes) {
  const std::uint64_t slot = slot_of(tile, row_count_[tile]++);
  reinterpret_cast<std::uint16_t*>(row_sample_.data())[slot] = static_cast<std::uint16_t>(sample);
  reinterpret_cast<std::uint64_t*>(changed_.data())[slot] = changes;
  return rows_.data() + slot * full_.row_bytes();
}

std::uint64_t TileLog::record_count() const {
  return std::accumulate(lane_records_.begin(), lane_records_.end(), std::uint64_t{0});
}

std::uint64_t TileLog::write(std::uint32_t samples, TilePolicy policy, PageBuffer& into) const {
  BlockGeometry geometry = full_;
  geometry.sample_count = samples;
  std::vector<TileEntry> entries(geometry.tile_count);
  std::uint64_t offset = geometry.directory_bytes();
  for (std::uint64_t tile = 0; tile < entries.size(); ++tile) {
    entries[tile] = choose(geometry, tile, policy);
    entries[tile].offset = static_cast<std::uint32_t>(offset / kBlockAlignment);
    offset += geometry.body_bytes(entries[tile]);
  }
  into.reserve(offset);
  std::memset(into.data(), 0, geometry.directory_bytes());
  std::memcpy(into.data(), entries.data(), entries.size() * sizeof(TileEntry));
  for (std::uint64_t tile = 0; tile < entries.size(); ++tile) {
    std::byte* body = into.data() + entries[tile].offset * kBlockAlignment;
    if (entries[tile].is_records()) {
      write_records(geometry, tile, entries[tile].slots(), body);
    } else {
      write_rows(geometry, tile, entries[tile].rows(), body);
    }
  }
  return offset;
}

void TileLog::clear() {
  std::fill(row_count_.begin(), row_count_.end(), 0);
  std::fill(lane_records_.begin(), lane_records_.end(), 0);
}

TileEntry TileLog::choose(const BlockGeometry& geometry, std::uint64_t tile, TilePolicy policy) const {
  const std::uint16_t* counts = lane_records_.data() + tile * kTilePixels;
  const std::uint32_t slots = *std::max_element(counts, counts + kTilePixels);
  const std::uint32_t rows = row_count_[tile];
  const bool as_records = policy == TilePolicy::records ||
                          (policy == TilePolicy::automatic && records_are_cheaper(geometry, rows, slots));
  return {0, as_records ? slots | TileEntry::kRecordsFlag : rows};
}

void TileLog::write_rows(const BlockGeometry& geometry, std::uint64_t tile, std::uint32_t rows,
                         std::byte* body) const {
  const std::uint64_t index_bytes = geometry.row_index_bytes(rows);
  std::memset(body, 0, index_bytes);
  for (std::uint32_t row = 0; index_bytes != 0 && row < rows; ++row) {
    write_index(geometry, body, row, row_samples(tile)[row]);
  }
  std::memcpy(body + index_bytes, row_at(tile, 0), rows * geometry.row_bytes());
}

void TileLog::write_records(const BlockGeometry& geometry, std::uint64_t tile, std::uint32_t slots,
                            std::byte* body) const {
  const std::uint64_t row_bytes = geometry.row_bytes();
  const std::uint64_t slot_bytes = geometry.slot_bytes();
  const std::uint64_t index_bytes = kTilePixels * geometry.index_bytes();
  const std::uint32_t rows = row_count_[tile];
  std::memcpy(body, row_at(tile, 0), row_bytes);
  // Padding first: every slot ends as "the last codes, at no sample of the block".
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    std::byte* index = body + row_bytes + slot * slot_bytes;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      write_index(geometry, index, lane, geometry.sample_count);
    }
    std::memcpy(index + index_bytes, row_at(tile, rows - 1), row_bytes);
  }
  std::array<std::uint16_t, kTilePixels> filled{};
  for (std::uint32_t row = 1; row < rows; ++row) {
    const std::byte* codes = row_at(tile, row);
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
