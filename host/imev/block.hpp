// A block: a run of consecutive samples, stored tile by tile exactly as the kernels read it.
//
// Payload (little-endian; every part starts at a multiple of 64 bytes; C channels of b bytes a code):
//
//   directory      one TileEntry per tile
//   tile bodies    in tile order, each of one of two kinds:
//
//   rows           the tile at each sample at which anything in it changed
//     index        [rows] sample numbers within the block, increasing, the first 0
//                  (absent where rows is 1 or the block's sample count: both are plain)
//     row 0 …      codes [C][64]
//
//   records        for each pixel its own change records, slot-major so that neighbours read neighbours
//     start        codes [C][64], held at the block's first sample
//     slot 0 …     index [64] sample numbers within the block, then codes [C][64];
//                  pixels with fewer records than slots repeat their last codes at index = sample count
//
// In files bodies lie one behind the other; in memory there may be room between them.
//
// An index takes one byte where the block has at most 255 samples, else two. A tile with one row is
// *still*, one with a row for every sample *dense*.
//
// A block starts from the codes held at its first sample: it can be read without the one before. That
// start is no change record. Between records the last codes hold.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "imev/tile.hpp"
#include "imev/tile_step.hpp"

namespace nutik {

// Payloads, headers and codes are copied between memory and files as they are.
static_assert(std::endian::native == std::endian::little,
              "files are little-endian and read without swapping");

inline constexpr std::uint64_t kBlockAlignment = 64;

[[nodiscard]] constexpr std::uint64_t align_up(std::uint64_t bytes, std::uint64_t alignment) {
  return (bytes + alignment - 1) / alignment * alignment;
}

struct TileEntry {
  static constexpr std::uint32_t kRecordsFlag = 0x8000'0000;

  std::uint32_t offset;  // of the body from the payload's start, in units of 64 bytes
  std::uint32_t count;   // rows, or slots with kRecordsFlag set

  [[nodiscard]] bool is_records() const { return (count & kRecordsFlag) != 0; }
  [[nodiscard]] std::uint32_t rows() const { return count; }
  [[nodiscard]] std::uint32_t slots() const { return count & ~kRecordsFlag; }
};
static_assert(sizeof(TileEntry) == 8 && offsetof(TileEntry, count) == 4);

enum class TileKind { still, rows, dense, records };

// Which samples a block holds.
struct BlockExtent {
  std::uint64_t first_sample = 0;
  std::uint32_t sample_count = 0;

  [[nodiscard]] SampleRange range() const { return {first_sample, first_sample + sample_count}; }
  friend bool operator==(const BlockExtent&, const BlockExtent&) = default;
};

// The sizes that follow from a capture's format and a block's length.
struct BlockGeometry {
  std::uint64_t tile_count;
  std::uint32_t sample_count;
  std::uint32_t channels;
  std::uint32_t code_bytes;
  CodeSteps steps;

  BlockGeometry(const CaptureFormat& capture, std::uint32_t samples)
      : tile_count(TileGrid(capture.shape).tile_count()),
        sample_count(samples),
        channels(capture.shape.channels),
        code_bytes(capture.code_bytes),
        steps(CodeSteps::of(capture)) {}

  [[nodiscard]] std::uint32_t index_bytes() const { return sample_count <= 255 ? 1 : 2; }
  [[nodiscard]] std::uint64_t row_bytes() const { return std::uint64_t{channels} * kTilePixels * code_bytes; }
  [[nodiscard]] std::uint64_t slot_bytes() const { return kTilePixels * index_bytes() + row_bytes(); }
  [[nodiscard]] std::uint64_t directory_bytes() const {
    return align_up(tile_count * sizeof(TileEntry), kBlockAlignment);
  }
  // Bytes of the index list before a tile's rows.
  [[nodiscard]] std::uint64_t row_index_bytes(std::uint32_t rows) const {
    return rows == 1 || rows == sample_count ? 0
                                             : align_up(std::uint64_t{rows} * index_bytes(), kBlockAlignment);
  }
  [[nodiscard]] std::uint64_t rows_bytes(std::uint32_t rows) const {
    return row_index_bytes(rows) + rows * row_bytes();
  }
  [[nodiscard]] std::uint64_t records_bytes(std::uint32_t slots) const {
    return row_bytes() + slots * slot_bytes();
  }
  [[nodiscard]] std::uint64_t body_bytes(const TileEntry& entry) const {
    return entry.is_records() ? records_bytes(entry.slots()) : rows_bytes(entry.rows());
  }
  // What is wrong with an entry that no tile of such a block can have ("has no row"); empty where it is
  // possible. Says nothing about its offset.
  [[nodiscard]] std::string flaw_of(const TileEntry& entry) const;
  [[nodiscard]] TileKind kind_of(const TileEntry& entry) const {
    if (entry.is_records()) return TileKind::records;
    if (entry.rows() == 1) return TileKind::still;
    return entry.rows() == sample_count ? TileKind::dense : TileKind::rows;
  }
};

// What building a block came to.
struct FinishedBlock {
  std::uint64_t payload_bytes = 0;  // without the room between bodies
  std::uint64_t span_bytes = 0;     // with it: from the directory to the last body's end
  std::uint64_t record_count = 0;   // change records, summed over pixels; starts are not counted
};

// One change record: from `sample` on (a number within the block) the pixel holds `codes`.
struct ChangeRecord {
  std::uint32_t sample = 0;
  std::array<std::uint16_t, 3> codes{};  // as many as there are channels

  friend bool operator==(const ChangeRecord&, const ChangeRecord&) = default;
};

// Reads a block's payload, which must outlive it.
class BlockView {
 public:
  // Throws InputError where the payload's directory does not fit its size.
  BlockView(const CaptureFormat& capture, BlockExtent extent, std::span<const std::byte> payload);

  [[nodiscard]] const BlockExtent& extent() const { return extent_; }
  [[nodiscard]] const BlockGeometry& geometry() const { return geometry_; }
  [[nodiscard]] std::span<const std::byte> payload() const { return payload_; }

  [[nodiscard]] TileEntry entry(std::uint64_t tile) const;
  [[nodiscard]] std::span<const std::byte> body(std::uint64_t tile) const;

  // Throws InputError, naming the tile, where sample numbers do not increase or are not the block's, or a code is above
  // white: what a checksum cannot tell of a file that was made up. Sources check what they read, so that every renderer
  // refuses the same. Of the tiles [first, last).
  void check_samples(std::uint64_t first, std::uint64_t last) const;
  // The same for whoever passes over the payload: looks at the tiles from `first` on whose bodies end within its first
  // `bytes`, and returns the first that does not; none where a number or a code is wrong.
  [[nodiscard]] std::optional<std::uint64_t> checked_until(std::uint64_t first, std::uint64_t bytes) const;

  // What one pixel holds: its start (sample 0) followed by its change records in time order. Rows of a
  // tile that leave the pixel's codes as they were are skipped. `history` is replaced. Sample numbers are
  // those of the block and strictly increase; throws InputError where the payload's do not.
  void read_history(std::uint64_t tile, std::uint32_t lane, std::vector<ChangeRecord>& history) const;

  // The rows of a tile that has some: calls visit(first, until, codes) for each, whose codes [C][64] all of its pixels
  // hold from one sample of the block until before another. Throws as read_history() does.
  template <typename Visit>
  void for_each_row(std::uint64_t tile, Visit visit) const {
    const TileEntry at = entry(tile);
    const std::byte* const codes = body(tile).data() + geometry_.row_index_bytes(at.rows());
    std::uint32_t first = row_sample(tile, 0, 0);
    for (std::uint32_t row = 0; row < at.rows(); ++row) {
      const std::uint32_t until =
          row + 1 < at.rows() ? row_sample(tile, row + 1, first) : geometry_.sample_count;
      visit(first, until, codes + row * geometry_.row_bytes());
      first = until;
    }
  }

  // The codes held at a sample of the block, as an interleaved raster of CaptureFormat::sample_bytes().
  // Throws as read_history() does.
  void read_sample(std::uint32_t sample, std::span<std::byte> raster) const;

 private:
  [[noreturn]] void fail(const std::string& why) const;
  [[nodiscard]] std::uint32_t index_at(const std::byte* list, std::uint64_t position) const;
  template <typename Index>
  [[nodiscard]] bool slots_increase(const std::byte* body, std::uint32_t slots) const;
  template <typename Index>
  [[nodiscard]] bool rows_increase(const std::byte* list, std::uint32_t rows) const;
  // Whether a tile's sample numbers do, and are the block's.
  [[nodiscard]] bool samples_increase(const TileEntry& at, const std::byte* body) const;
  // The largest code of a tile, padding included; 0 where none can be larger than white.
  [[nodiscard]] std::uint32_t largest_code(const TileEntry& at, const std::byte* body) const;
  // The sample at which a row of a tile of rows begins, the one before it beginning at `before`.
  [[nodiscard]] std::uint32_t row_sample(std::uint64_t tile, std::uint32_t row, std::uint32_t before) const;
  [[nodiscard]] ChangeRecord record_at(std::uint32_t sample, const std::byte* codes,
                                       std::uint32_t lane) const;

  Shape shape_;
  std::uint32_t white_code_;
  BlockExtent extent_;
  BlockGeometry geometry_;
  std::span<const std::byte> payload_;
  std::vector<TileEntry> entries_;  // as they were checked: a mapped file may be written to meanwhile
};

}  // namespace nutik
