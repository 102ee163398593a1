#include "imev/block_builder.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"

// The innermost loops are compiled for several instruction sets and chosen when the program starts:
// without it the transposition of a frame takes longer than decoding it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define NUTIK_SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define NUTIK_SIMD_CLONES
#endif

namespace nutik {

std::uint32_t default_block_samples(const CaptureFormat& capture, std::uint64_t block_bytes) {
  const std::uint64_t fitting = block_bytes / std::max<std::uint64_t>(capture.sample_bytes(), 1);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(fitting, 1, kDefaultBlockSamples));
}

namespace {

// Moves one tile from an interleaved raster to planes: codes[channel][lane]. `row_values` is the number
// of values from one raster row to the next.
template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) void gather_tile(const Code* raster, std::size_t row_values,
                                                       Code* codes) {
  for (std::uint32_t y = 0; y < kTileSide; ++y) {
    const Code* from = raster + y * row_values;
    for (std::uint32_t channel = 0; channel < Channels; ++channel) {
      for (std::uint32_t x = 0; x < kTileSide; ++x) {
        codes[channel * kTilePixels + y * kTileSide + x] = from[x * Channels + channel];
      }
    }
  }
}

// The same for 8-bit colour, which most clips are: a row's 24 bytes are read as two overlapping vectors and
// each plane's 8 picked from them: 2.5 ms a frame of 1080p instead of the plain loop's 4.2.
template <>
inline __attribute__((always_inline)) void gather_tile<std::uint8_t, 3>(const std::uint8_t* raster,
                                                                        std::size_t row_values,
                                                                        std::uint8_t* codes) {
  using Bytes = std::uint8_t __attribute__((vector_size(16)));
  for (std::uint32_t y = 0; y < kTileSide; ++y) {
    Bytes low, high;  // bytes 0 … 15 and 8 … 23 of the row: byte k of these is k or, from 16 on, k + 8
    std::memcpy(&low, raster + y * row_values, 16);
    std::memcpy(&high, raster + y * row_values + 8, 16);
    const Bytes first = __builtin_shufflevector(low, high, 0, 3, 6, 9, 12, 15, 26, 29,  //
                                                1, 4, 7, 10, 13, 24, 27, 30);
    const Bytes last = __builtin_shufflevector(low, high, 2, 5, 8, 11, 14, 25, 28, 31,  //
                                               2, 5, 8, 11, 14, 25, 28, 31);
    std::memcpy(codes + y * kTileSide, &first, 8);
    std::memcpy(codes + kTilePixels + y * kTileSide, reinterpret_cast<const char*>(&first) + 8, 8);
    std::memcpy(codes + 2 * kTilePixels + y * kTileSide, &last, 8);
  }
}

// What a tile of a sample is compared with, and what its changes are counted in.
struct TileStep {
  const std::byte* raster;
  std::size_t row_values;
  std::uint32_t tolerance;
  std::byte* held;        // codes[channel][lane]; those that change are replaced
  std::uint16_t* counts;  // change records of every lane; null where the change is none
};

// A value for each lane of a tile; compilers cut these vectors into what the machine has.
using Lanes8 = std::uint8_t __attribute__((vector_size(kTilePixels)));
using Lanes16 = std::uint16_t __attribute__((vector_size(2 * kTilePixels)));

// Lanes 0 … 63 of `differs`, each 0 or 1, as bits 0 … 63.
inline __attribute__((always_inline)) std::uint64_t pack_lanes(const std::uint8_t* differs) {
  std::uint64_t bits = 0;
  for (std::uint32_t byte = 0; byte < 8; ++byte) {
    std::uint64_t eight;
    std::memcpy(&eight, differs + byte * 8, 8);
    bits |= (eight * 0x0102'0408'1020'4080u >> 56) << (byte * 8);
  }
  return bits;
}

// The step that every tile of every sample takes: the lanes, as bits, in which any channel is further than
// the tolerance from what is held.
template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) std::uint64_t step_tile(const TileStep& step) {
  using Lanes = std::conditional_t<sizeof(Code) == 1, Lanes8, Lanes16>;
  alignas(64) Code codes[Channels * kTilePixels];
  gather_tile<Code, Channels>(reinterpret_cast<const Code*>(step.raster), step.row_values, codes);
  if (std::memcmp(codes, step.held, sizeof codes) == 0) return 0;

  Lanes now[Channels], held[Channels], differs{};
  std::memcpy(now, codes, sizeof now);
  std::memcpy(held, step.held, sizeof held);
  // No distance is above the largest code: a larger tolerance means the same, but would not fit.
  const auto limit =
      static_cast<Code>(std::min<std::uint32_t>(step.tolerance, std::numeric_limits<Code>::max()));
  for (std::uint32_t channel = 0; channel < Channels; ++channel) {
    const Lanes distance =
        now[channel] > held[channel] ? now[channel] - held[channel] : held[channel] - now[channel];
    differs |= reinterpret_cast<Lanes>(distance > limit);
  }
  for (std::uint32_t channel = 0; channel < Channels; ++channel) {
    held[channel] = differs != 0 ? now[channel] : held[channel];
  }
  std::memcpy(step.held, held, sizeof held);
  const Lanes8 marks = __builtin_convertvector(differs, Lanes8) & 1;
  if (step.counts != nullptr) {
    Lanes16 counts;
    std::memcpy(&counts, step.counts, sizeof counts);
    counts += __builtin_convertvector(marks, Lanes16);
    std::memcpy(step.counts, &counts, sizeof counts);
  }
  std::uint8_t bytes[kTilePixels];
  std::memcpy(bytes, &marks, sizeof bytes);
  return pack_lanes(bytes);
}

NUTIK_SIMD_CLONES std::uint64_t step_grey8(const TileStep& step) { return step_tile<std::uint8_t, 1>(step); }
NUTIK_SIMD_CLONES std::uint64_t step_grey16(const TileStep& step) {
  return step_tile<std::uint16_t, 1>(step);
}
NUTIK_SIMD_CLONES std::uint64_t step_colour8(const TileStep& step) {
  return step_tile<std::uint8_t, 3>(step);
}
NUTIK_SIMD_CLONES std::uint64_t step_colour16(const TileStep& step) {
  return step_tile<std::uint16_t, 3>(step);
}

using StepFunction = std::uint64_t (*)(const TileStep&);

StepFunction step_function(const CaptureFormat& capture) {
  if (capture.shape.channels == 1) return capture.code_bytes == 1 ? step_grey8 : step_grey16;
  return capture.code_bytes == 1 ? step_colour8 : step_colour16;
}

// Whether the largest payload that a block of so many samples may come to stays within the limit. One tile
// takes less than 2^26 bytes, so that only their number needs care.
bool fits_payload(const CaptureFormat& capture, std::uint32_t samples, TilePolicy policy) {
  const BlockGeometry geometry(capture, samples);
  const std::uint64_t rows = std::max(geometry.rows_bytes(samples), geometry.rows_bytes(samples - 1));
  // Chosen for their cost, records take fewer bytes than the rows would.
  const std::uint64_t body = policy == TilePolicy::records ? geometry.records_bytes(samples - 1) : rows;
  return geometry.tile_count <= kLargestPayloadBytes / (body + sizeof(TileEntry) + kBlockAlignment);
}

void check_block_samples(const CaptureFormat& capture, std::uint32_t samples, TilePolicy policy) {
  if (samples == 0 || samples > kLargestBlockSamples) {
    throw UsageError(format("a block of {} samples is outside 1 … {}", samples, kLargestBlockSamples));
  }
  if (fits_payload(capture, samples, policy)) return;
  std::uint32_t fitting = 0, too_many = samples;
  while (fitting + 1 < too_many) {
    const std::uint32_t middle = std::midpoint(fitting, too_many);
    (fits_payload(capture, middle, policy) ? fitting : too_many) = middle;
  }
  throw UsageError(format(
      "a block of {} samples of {} x {} pixels may come to more than the {} GiB that a block can have; "
      "use --block-samples {} or less",
      samples, capture.shape.width, capture.shape.height, kLargestPayloadBytes >> 30, fitting));
}

}  // namespace

// While a block is open each tile has room for a row per sample, in address space: [tile][row][C][64].
// Only rows that are used are ever touched.
class BlockBuilder::Implementation {
 public:
  Implementation(const CaptureFormat& capture, std::uint32_t block_samples, TilePolicy policy)
      : capture_(capture),
        grid_(capture.shape),
        geometry_(capture, block_samples),
        policy_(policy),
        step_(step_function(capture)),
        held_(grid_.tile_count() * geometry_.row_bytes()),
        rows_(grid_.tile_count() * block_samples * geometry_.row_bytes()),
        changed_(grid_.tile_count() * block_samples * sizeof(std::uint64_t)),
        row_sample_(grid_.tile_count() * block_samples * sizeof(std::uint16_t)),
        row_count_(grid_.tile_count()),
        lane_records_(grid_.tile_count() * kTilePixels) {}

  void add(std::span<const std::byte> raster) {
    if (raster.size() != capture_.sample_bytes()) {
      throw std::logic_error("a sample's raster has the wrong size");
    }
    if (is_full()) throw std::logic_error("a full block was given another sample");
    check_white(raster);
    for (std::uint32_t row = 0; row < grid_.rows(); ++row) {
      for (std::uint32_t column = 0; column < grid_.columns(); ++column) {
        add_tile(row, column, raster);
      }
    }
    ++samples_;
  }

  [[nodiscard]] bool is_full() const { return samples_ == geometry_.sample_count; }
  [[nodiscard]] bool is_empty() const { return samples_ == 0; }
  [[nodiscard]] BlockExtent extent() const { return {first_sample_, samples_}; }
  [[nodiscard]] std::uint64_t record_count() const {
    return std::accumulate(lane_records_.begin(), lane_records_.end(), std::uint64_t{0});
  }

  std::uint64_t finish(PageBuffer& into) {
    if (is_empty()) throw std::logic_error("a block without samples was finished");
    BlockGeometry geometry = geometry_;
    geometry.sample_count = samples_;
    std::vector<TileEntry> entries(grid_.tile_count());
    std::uint64_t offset = geometry.directory_bytes();
    for (std::uint64_t tile = 0; tile < entries.size(); ++tile) {
      entries[tile] = choose(geometry, tile);
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
    begin_next();
    return offset;
  }

  void pass(std::span<const std::byte> raster) {
    if (!is_empty()) throw std::logic_error("a sample was passed over within a block");
    // A lossless block starts from its first sample, whatever was held before.
    if (capture_.noise.is_lossless()) {
      ++first_sample_;
      return;
    }
    add(raster);
    begin_next();
  }

 private:
  void begin_next() {
    first_sample_ += samples_;
    samples_ = 0;
    std::fill(row_count_.begin(), row_count_.end(), 0);
    std::fill(lane_records_.begin(), lane_records_.end(), 0);
  }

  void check_white(std::span<const std::byte> raster) const {
    const std::uint32_t largest_possible = capture_.code_bytes == 1 ? 255 : 65'535;
    if (capture_.white_code >= largest_possible) return;
    std::uint32_t largest = 0;
    if (capture_.code_bytes == 1) {
      for (const std::byte code : raster) largest = std::max(largest, static_cast<std::uint32_t>(code));
    } else {
      const auto* codes = reinterpret_cast<const std::uint16_t*>(raster.data());
      for (std::size_t i = 0; i < raster.size() / 2; ++i) {
        largest = std::max<std::uint32_t>(largest, codes[i]);
      }
    }
    if (largest > capture_.white_code) {
      throw InputError(
          format("sample {} has a code of {}, above the white code {}; state the right one "
                 "with --white",
                 first_sample_ + samples_, largest, capture_.white_code));
    }
  }

  [[nodiscard]] std::byte* row_at(std::uint64_t tile, std::uint32_t row) {
    return rows_.data() + (tile * geometry_.sample_count + row) * geometry_.row_bytes();
  }
  [[nodiscard]] std::uint16_t* row_samples(std::uint64_t tile) {
    return reinterpret_cast<std::uint16_t*>(row_sample_.data()) + tile * geometry_.sample_count;
  }
  [[nodiscard]] std::uint64_t* row_changes(std::uint64_t tile) {
    return reinterpret_cast<std::uint64_t*>(changed_.data()) + tile * geometry_.sample_count;
  }

  void add_tile(std::uint32_t tile_row, std::uint32_t tile_column, std::span<const std::byte> raster) {
    const std::uint64_t tile = std::uint64_t{tile_row} * grid_.columns() + tile_column;
    const std::uint32_t left = tile_column * kTileSide;
    const std::uint32_t top = tile_row * kTileSide;
    const Shape& shape = capture_.shape;
    const std::size_t value_bytes = std::size_t{shape.channels} * capture_.code_bytes;

    alignas(64) std::array<std::byte, kTilePixels * 3 * 2> padded;
    TileStep step{};
    step.held = held_.data() + tile * geometry_.row_bytes();
    const bool starts = samples_ == 0;  // and a start is no record
    step.counts = starts ? nullptr : lane_records_.data() + tile * kTilePixels;
    // The capture's first sample is held whatever it is: nothing was held before.
    const bool first_of_capture = first_sample_ == 0 && samples_ == 0;
    step.tolerance = first_of_capture ? 0 : capture_.noise.tolerance;
    if (left + kTileSide <= shape.width && top + kTileSide <= shape.height) {
      step.raster = raster.data() + (std::size_t{top} * shape.width + left) * value_bytes;
      step.row_values = std::size_t{shape.width} * shape.channels;
    } else {
      grid_.for_each_lane(tile, [&](std::uint32_t lane, std::uint64_t pixel) {
        std::memcpy(padded.data() + lane * value_bytes, raster.data() + pixel * value_bytes, value_bytes);
      });
      step.raster = padded.data();
      step.row_values = std::size_t{kTileSide} * shape.channels;
    }

    const std::uint64_t changes = step_(step);
    if (changes == 0 && !starts && policy_ != TilePolicy::dense) return;
    const std::uint32_t row = row_count_[tile]++;
    std::memcpy(row_at(tile, row), step.held, geometry_.row_bytes());
    row_samples(tile)[row] = static_cast<std::uint16_t>(samples_);
    row_changes(tile)[row] = starts ? 0 : changes;
  }

  [[nodiscard]] TileEntry choose(const BlockGeometry& geometry, std::uint64_t tile) const {
    const std::uint16_t* counts = lane_records_.data() + tile * kTilePixels;
    const std::uint32_t slots = *std::max_element(counts, counts + kTilePixels);
    const std::uint32_t rows = row_count_[tile];
    const bool as_records = policy_ == TilePolicy::records ||
                            (policy_ == TilePolicy::automatic && records_are_cheaper(geometry, rows, slots));
    return {0, as_records ? slots | TileEntry::kRecordsFlag : rows};
  }

  static void write_index(const BlockGeometry& geometry, std::byte* list, std::uint64_t position,
                          std::uint32_t sample) {
    if (geometry.index_bytes() == 1) {
      list[position] = static_cast<std::byte>(sample);
    } else {
      const auto wide = static_cast<std::uint16_t>(sample);
      std::memcpy(list + position * 2, &wide, sizeof wide);
    }
  }

  void write_rows(const BlockGeometry& geometry, std::uint64_t tile, std::uint32_t rows, std::byte* body) {
    const std::uint64_t index_bytes = geometry.row_index_bytes(rows);
    std::memset(body, 0, index_bytes);
    for (std::uint32_t row = 0; index_bytes != 0 && row < rows; ++row) {
      write_index(geometry, body, row, row_samples(tile)[row]);
    }
    std::memcpy(body + index_bytes, row_at(tile, 0), rows * geometry.row_bytes());
  }

  void write_records(const BlockGeometry& geometry, std::uint64_t tile, std::uint32_t slots,
                     std::byte* body) {
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

  CaptureFormat capture_;
  TileGrid grid_;
  BlockGeometry geometry_;  // of a full block
  TilePolicy policy_;
  StepFunction step_;

  std::uint64_t first_sample_ = 0;
  std::uint32_t samples_ = 0;
  PageBuffer held_;                          // [tile][C][64] codes
  PageBuffer rows_;                          // [tile][sample_count][C][64] codes
  PageBuffer changed_;                       // [tile][sample_count] lanes that changed with the row, as bits
  PageBuffer row_sample_;                    // [tile][sample_count] sample of each row within the block
  std::vector<std::uint32_t> row_count_;     // [tile]
  std::vector<std::uint16_t> lane_records_;  // [tile][64] change records of each pixel in the block
};

BlockBuilder::BlockBuilder(const CaptureFormat& capture, std::uint32_t block_samples, TilePolicy policy) {
  check_block_samples(capture, block_samples, policy);
  implementation_ = std::make_unique<Implementation>(capture, block_samples, policy);
}

BlockBuilder::~BlockBuilder() = default;
BlockBuilder::BlockBuilder(BlockBuilder&&) noexcept = default;
BlockBuilder& BlockBuilder::operator=(BlockBuilder&&) noexcept = default;

void BlockBuilder::add(std::span<const std::byte> raster) { implementation_->add(raster); }
bool BlockBuilder::is_full() const { return implementation_->is_full(); }
bool BlockBuilder::is_empty() const { return implementation_->is_empty(); }
BlockExtent BlockBuilder::extent() const { return implementation_->extent(); }
std::uint64_t BlockBuilder::record_count() const { return implementation_->record_count(); }
std::uint64_t BlockBuilder::finish(PageBuffer& into) { return implementation_->finish(into); }
void BlockBuilder::pass(std::span<const std::byte> raster) { implementation_->pass(raster); }

}  // namespace nutik
