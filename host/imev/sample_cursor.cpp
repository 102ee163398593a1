#include "imev/sample_cursor.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace nutik {
namespace {

constexpr std::uint32_t kNever = ~std::uint32_t{0};
constexpr std::uint32_t kTilesAhead = 8;

std::uint32_t index_at(const std::byte* list, std::uint32_t position, std::uint32_t bytes) {
  if (bytes == 1) return std::to_integer<std::uint32_t>(list[position]);
  std::uint16_t value;
  std::memcpy(&value, list + std::size_t{position} * sizeof value, sizeof value);
  return value;
}

}  // namespace

SampleCursor::SampleCursor(const Shape& shape, const BlockView& block)
    : block_(block), shape_(shape), grid_(shape), tiles_(block.geometry().tile_count) {
  std::uint64_t records_tiles = 0;
  for (std::uint64_t tile = 0; tile < tiles_.size(); ++tile) {
    records_tiles += block.entry(tile).is_records() ? 1 : 0;
  }
  gathered_.resize(records_tiles * block.geometry().row_bytes());
  const std::byte* room = gathered_.data();
  for (std::uint64_t tile = 0; tile < tiles_.size(); ++tile) {
    if (!block.entry(tile).is_records()) continue;
    tiles_[tile].codes = room;
    room += block.geometry().row_bytes();
  }
}

std::span<const std::uint32_t> SampleCursor::go_to(std::uint32_t sample) {
  changed_.clear();
  for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile) {
    fetch(tile + kTilesAhead, sample);
    if (tiles_[tile].next > sample) continue;
    changed_.push_back(tile);
    if (!block_.entry(tile).is_records()) {
      go_to_row(tile, sample);
    } else if (block_.geometry().index_bytes() == 1) {
      gather_records<std::uint8_t>(tile, sample);
    } else {
      gather_records<std::uint16_t>(tile, sample);
    }
  }
  return changed_;
}

std::uint32_t SampleCursor::code(std::uint32_t x, std::uint32_t y, std::uint32_t channel) const {
  return index_at(codes(grid_.tile_of(x, y)), channel * kTilePixels + TileGrid::lane_of(x, y),
                  block_.geometry().code_bytes);
}

void SampleCursor::read(std::span<std::byte> raster) const {
  with_codes(block_.geometry().code_bytes, raster.data(), [&]<typename Code>(Code* codes) {
    shape_.channels == 1 ? read<Code, 1>(codes) : read<Code, 3>(codes);
  });
}

template <typename Code, std::uint32_t kChannels>
void SampleCursor::read(Code* raster) const {
  for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile) {
    const auto* const planes = reinterpret_cast<const Code*>(tiles_[tile].codes);
    const std::uint32_t left = tile % grid_.columns() * kTileSide, top = tile / grid_.columns() * kTileSide;
    const std::uint32_t wide = std::min(kTileSide, shape_.width - left);
    const std::uint32_t high = std::min(kTileSide, shape_.height - top);
    for (std::uint32_t y = 0; y < high; ++y) {
      Code* to = raster + (std::size_t{top + y} * shape_.width + left) * kChannels;
      const Code* const from = planes + std::size_t{y} * kTileSide;
      for (std::uint32_t x = 0; x < wide; ++x) {
        for (std::uint32_t channel = 0; channel < kChannels; ++channel)
          *to++ = from[channel * kTilePixels + x];
      }
    }
  }
}

// Tells the processor what will be read of a tile: it lies far from what is read of the one before.
void SampleCursor::fetch(std::uint32_t tile, std::uint32_t sample) const {
  if (tile >= tiles_.size() || tiles_[tile].next > sample) return;
  const TileEntry entry = block_.entry(tile);
  if (entry.is_records()) return;
  const BlockGeometry& geometry = block_.geometry();
  const std::byte* const body = block_.body(tile).data();
  const std::uint32_t row = tiles_[tile].row;
  __builtin_prefetch(body + std::size_t{row} * geometry.index_bytes());
  __builtin_prefetch(body + geometry.row_index_bytes(entry.rows()) + row * geometry.row_bytes());
}

// To the row that all pixels of a tile hold at a sample.
void SampleCursor::go_to_row(std::uint32_t tile, std::uint32_t sample) {
  const BlockGeometry& geometry = block_.geometry();
  const std::uint32_t rows = block_.entry(tile).rows(), bytes = geometry.index_bytes();
  const std::byte* const body = block_.body(tile).data();
  const std::uint64_t list_bytes = geometry.row_index_bytes(rows);
  Tile& at = tiles_[tile];
  if (list_bytes == 0) {  // still or dense
    at.row = std::min(sample + 1, rows);
    at.next = at.row < rows ? at.row : kNever;
  } else {
    ++at.row;  // the first is at sample 0
    while (at.row < rows && index_at(body, at.row, bytes) <= sample) ++at.row;
    at.next = at.row < rows ? index_at(body, at.row, bytes) : kNever;
  }
  at.codes = body + list_bytes + (at.row - 1) * geometry.row_bytes();
}

// Gathers what each pixel of a tile holds at a sample, by its own records.
template <typename Index>
void SampleCursor::gather_records(std::uint32_t tile, std::uint32_t sample) {
  const BlockGeometry& geometry = block_.geometry();
  const std::uint32_t slots = block_.entry(tile).slots();
  const std::byte* const body = block_.body(tile).data();
  std::array<std::uint16_t, kTilePixels> passed{};  // of a lane's records
  std::array<Index, kTilePixels> indices;
  Index next = static_cast<Index>(geometry.sample_count);
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    std::memcpy(indices.data(), body + geometry.row_bytes() + slot * geometry.slot_bytes(), sizeof indices);
    unsigned past = 0;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      const bool is_past = indices[lane] <= sample;
      past += is_past ? 1 : 0;
      passed[lane] = static_cast<std::uint16_t>(passed[lane] + (is_past ? 1 : 0));
      next = std::min(next, is_past ? next : indices[lane]);
    }
    if (past == 0) break;  // nor any that follow
  }
  tiles_[tile].next = next < geometry.sample_count ? std::uint32_t{next} : kNever;
  std::byte* const to = gathered_.data() + (tiles_[tile].codes - gathered_.data());
  with_codes(geometry.code_bytes, to, [&](auto* codes) {
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      const std::byte* from = body;
      if (passed[lane] > 0) {
        from += geometry.row_bytes() + (passed[lane] - 1u) * geometry.slot_bytes() + sizeof indices;
      }
      for (std::uint32_t channel = 0; channel < geometry.channels; ++channel) {
        const std::size_t at = channel * kTilePixels + lane;
        std::memcpy(codes + at, from + at * sizeof *codes, sizeof *codes);
      }
    }
  });
}

}  // namespace nutik
