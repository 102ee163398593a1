#include "imev/block.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/sample_cursor.hpp"
#include "system/parallel.hpp"
#include "system/simd_clones.hpp"

namespace nutik {
namespace {

std::uint32_t read_unsigned(const std::byte* at, std::uint32_t bytes) {
  if (bytes == 1) return static_cast<std::uint32_t>(*at);
  std::uint16_t value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// A file is checked as fast as it is read.
NUTIK_SIMD_CLONES std::uint32_t largest_of(const std::uint8_t* codes, std::uint64_t count) {
  std::uint8_t largest = 0;
  for (std::uint64_t i = 0; i < count; ++i) largest = std::max(largest, codes[i]);
  return largest;
}
NUTIK_SIMD_CLONES std::uint32_t largest_of(const std::uint16_t* codes, std::uint64_t count) {
  std::uint16_t largest = 0;
  for (std::uint64_t i = 0; i < count; ++i) largest = std::max(largest, codes[i]);
  return largest;
}

}  // namespace

std::string BlockGeometry::flaw_of(const TileEntry& entry) const {
  if (entry.is_records()) {
    if (entry.slots() < sample_count) return {};
    return format("has {} change records a pixel; in {} samples there are at most {}", entry.slots(),
                  sample_count, sample_count - 1);
  }
  if (entry.rows() == 0) return "has no row";
  if (entry.rows() <= sample_count) return {};
  return format("has {} rows; {} samples have at most as many", entry.rows(), sample_count);
}

BlockView::BlockView(const CaptureFormat& capture, BlockExtent extent, std::span<const std::byte> payload)
    : shape_(capture.shape),
      white_code_(capture.white_code),
      extent_(extent),
      geometry_(capture, extent.sample_count),
      payload_(payload) {
  if (extent.sample_count == 0) fail("it holds no sample");
  if (payload.size() < geometry_.directory_bytes()) {
    fail(format("its {} bytes end within the tile directory of {}", payload.size(),
                geometry_.directory_bytes()));
  }
  entries_.resize(geometry_.tile_count);
  std::memcpy(entries_.data(), payload.data(), entries_.size() * sizeof(TileEntry));
  for (std::uint64_t tile = 0; tile < geometry_.tile_count; ++tile) {
    const TileEntry at = entry(tile);
    if (const std::string flaw = geometry_.flaw_of(at); !flaw.empty()) fail(format("tile {} {}", tile, flaw));
    const std::uint64_t end = at.offset * kBlockAlignment + geometry_.body_bytes(at);
    if (at.offset * kBlockAlignment < geometry_.directory_bytes() || end > payload.size()) {
      fail(format("tile {} lies outside its {} bytes", tile, payload.size()));
    }
  }
}

void BlockView::fail(const std::string& why) const {
  throw InputError(format("the block of samples {} to {} is damaged: {}", extent_.first_sample,
                          extent_.range().last - 1, why));
}

TileEntry BlockView::entry(std::uint64_t tile) const { return entries_[tile]; }

std::span<const std::byte> BlockView::body(std::uint64_t tile) const {
  const TileEntry at = entry(tile);
  return payload_.subspan(at.offset * kBlockAlignment, geometry_.body_bytes(at));
}

std::uint32_t BlockView::index_at(const std::byte* list, std::uint64_t position) const {
  const std::uint32_t bytes = geometry_.index_bytes();
  return read_unsigned(list + position * bytes, bytes);
}

ChangeRecord BlockView::record_at(std::uint32_t sample, const std::byte* codes, std::uint32_t lane) const {
  ChangeRecord record;
  record.sample = sample;
  for (std::uint32_t channel = 0; channel < geometry_.channels; ++channel) {
    record.codes[channel] = static_cast<std::uint16_t>(
        read_unsigned(codes + (channel * kTilePixels + lane) * geometry_.code_bytes, geometry_.code_bytes));
  }
  return record;
}

std::uint32_t BlockView::row_sample(std::uint64_t tile, std::uint32_t row, std::uint32_t before) const {
  const bool has_list = geometry_.row_index_bytes(entry(tile).rows()) != 0;
  const std::uint32_t sample = has_list ? index_at(body(tile).data(), row) : row;
  if (row == 0 ? sample != 0 : sample <= before || sample >= geometry_.sample_count) {
    fail(row == 0 ? format("tile {}: its first row is at sample {}, not 0", tile, sample)
                  : format("tile {}: its row {} is at sample {} of {}, the one before at {}", tile, row,
                           sample, geometry_.sample_count, before));
  }
  return sample;
}

// Looks at all pixels of a slot side by side: a file is checked as fast as it is read.
template <typename Index>
bool BlockView::slots_increase(const std::byte* body, std::uint32_t slots) const {
  const auto end = static_cast<Index>(geometry_.sample_count);
  std::array<Index, kTilePixels> before{}, now;
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    std::memcpy(now.data(), body + geometry_.row_bytes() + slot * geometry_.slot_bytes(), sizeof now);
    unsigned flaws = 0;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      flaws |= static_cast<unsigned>(now[lane] > end) |
               (static_cast<unsigned>(now[lane] <= before[lane]) & static_cast<unsigned>(now[lane] != end));
    }
    if (flaws != 0) return false;
    before = now;
  }
  return true;
}

template <typename Index>
bool BlockView::rows_increase(const std::byte* list, std::uint32_t rows) const {
  Index before = 0, now = 0;
  std::memcpy(&now, list, sizeof now);
  unsigned flaws = now != 0;
  for (std::uint32_t row = 1; row < rows; ++row, before = now) {
    std::memcpy(&now, list + row * sizeof now, sizeof now);
    flaws |= static_cast<unsigned>(now <= before) | static_cast<unsigned>(now >= geometry_.sample_count);
  }
  return flaws == 0;
}

bool BlockView::samples_increase(const TileEntry& at, const std::byte* body) const {
  const bool is_narrow = geometry_.index_bytes() == 1;
  if (at.is_records()) {
    return is_narrow ? slots_increase<std::uint8_t>(body, at.slots())
                     : slots_increase<std::uint16_t>(body, at.slots());
  }
  if (geometry_.row_index_bytes(at.rows()) == 0) return true;  // still or dense: no list
  return is_narrow ? rows_increase<std::uint8_t>(body, at.rows())
                   : rows_increase<std::uint16_t>(body, at.rows());
}

std::uint32_t BlockView::largest_code(const TileEntry& at, const std::byte* body) const {
  if (white_code_ >= (geometry_.code_bytes == 1 ? 255u : 65'535u)) return 0;
  const auto of_rows = [&](const std::byte* codes, std::uint64_t rows) {
    const std::uint64_t bytes = rows * geometry_.row_bytes();
    return geometry_.code_bytes == 1 ? largest_of(reinterpret_cast<const std::uint8_t*>(codes), bytes)
                                     : largest_of(reinterpret_cast<const std::uint16_t*>(codes), bytes / 2);
  };
  if (!at.is_records()) return of_rows(body + geometry_.row_index_bytes(at.rows()), at.rows());
  std::uint32_t largest = of_rows(body, 1);
  for (std::uint32_t slot = 1; slot <= at.slots(); ++slot)
    largest = std::max(largest, of_rows(body + slot * geometry_.slot_bytes(), 1));
  return largest;
}

std::optional<std::uint64_t> BlockView::checked_until(std::uint64_t first, std::uint64_t bytes) const {
  for (; first < geometry_.tile_count; ++first) {
    const TileEntry& at = entries_[first];
    const std::uint64_t begin = at.offset * kBlockAlignment;
    if (begin + geometry_.body_bytes(at) > bytes) break;
    const std::byte* const body = payload_.data() + begin;
    if (!samples_increase(at, body) || largest_code(at, body) > white_code_) return {};
  }
  return first;
}

void BlockView::check_samples(std::uint64_t first, std::uint64_t last) const {
  parallel_for_parts(last - first, 4096, [&](std::uint64_t begin, std::uint64_t end) {
    std::vector<ChangeRecord> history;
    for (std::uint64_t tile = first + begin; tile < first + end; ++tile) {
      const TileEntry at = entry(tile);
      if (const std::uint32_t largest = largest_code(at, body(tile).data()); largest > white_code_)
        fail(format("tile {} has a code of {}, above its white code {}", tile, largest, white_code_));
      if (samples_increase(at, body(tile).data())) continue;
      // Again, for the sentence that says where not.
      for (std::uint32_t row = 0, before = 0; !at.is_records() && row < at.rows(); ++row) {
        before = row_sample(tile, row, before);
      }
      for (std::uint32_t lane = 0; at.is_records() && lane < kTilePixels; ++lane)
        read_history(tile, lane, history);
    }
  });
}

// Checked once more: not every payload comes from a file.
void BlockView::read_history(std::uint64_t tile, std::uint32_t lane,
                             std::vector<ChangeRecord>& history) const {
  history.clear();
  const TileEntry at = entry(tile);
  const std::byte* bytes = body(tile).data();
  if (at.is_records()) {
    history.push_back(record_at(0, bytes, lane));
    std::uint32_t before = 0;
    for (std::uint32_t slot = 0; slot < at.slots(); ++slot) {
      const std::byte* index = bytes + geometry_.row_bytes() + slot * geometry_.slot_bytes();
      const std::uint32_t sample = index_at(index, lane);
      const bool is_padding = sample == geometry_.sample_count;
      if (sample > geometry_.sample_count || (sample <= before && !is_padding)) {
        fail(format("tile {}, pixel {}: its change record {} is at sample {} of {}, the one before at {}",
                    tile, lane, slot, sample, geometry_.sample_count, before));
      }
      before = sample;
      if (!is_padding)
        history.push_back(record_at(sample, index + kTilePixels * geometry_.index_bytes(), lane));
    }
    return;
  }
  for_each_row(tile, [&](std::uint32_t sample, std::uint32_t, const std::byte* codes) {
    const ChangeRecord record = record_at(sample, codes, lane);
    if (history.empty() || history.back().codes != record.codes) history.push_back(record);
  });
}

void BlockView::read_sample(std::uint32_t sample, std::span<std::byte> raster) const {
  check_samples(0, geometry_.tile_count);
  SampleCursor cursor(shape_, *this);
  cursor.go_to(sample);
  cursor.read(raster);
}

}  // namespace nutik
