// Builds blocks from samples, one after another.
//
//   in:      samples as interleaved rasters, in time order
//   out:     a block's payload each time it is full or the capture ends (layout: imev/block.hpp)
//   always:  memory for one block besides those handed out, whatever the capture's length, and for no more than what
//            the block really holds, unless a camera's noise is known. With a tolerance the codes held at a block's
//            end go over into the next, so that blocks change nothing about what is a change; with a camera's noise
//            each block stands on its own samples (imev/expected_values.hpp)
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

#include "capture/picture.hpp"
#include "capture/pixel_change.hpp"
#include "imev/block.hpp"
#include "imev/tile_cost.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

inline constexpr std::uint32_t kDefaultBlockSamples = 64;
inline constexpr std::uint32_t kLargestBlockSamples = 65'535;  // an index has two bytes at most
inline constexpr std::uint64_t kLargestPayloadBytes =          // a tile's offset has 32 bits
    (std::uint64_t{1} << 32) * kBlockAlignment;
inline constexpr std::uint64_t kDefaultBlockBytes = 128ull << 20;

// When a block closes: with the last of so many samples, or with the one by which what changed since the block's first
// comes to so many bytes. Changes are counted as rows: a tile in which anything changed counts as a whole, as records
// or not. The first sample is not counted, for every block has one: shorter blocks would only repeat it more often.
struct BlockLimits {
  static constexpr std::uint64_t kAnyChanges = ~std::uint64_t{0};

  std::uint32_t samples;
  std::uint64_t changed_bytes;
  // What the block may take while it is built, with the room between its bodies: about where it closes. Two times as
  // much and a sample it may come to (builder_bytes()).
  std::uint64_t memory_bytes = kAnyChanges;

  BlockLimits(std::uint32_t max_samples,
              std::uint64_t max_changed_bytes = kAnyChanges)  // NOLINT: so many samples
      : samples(max_samples), changed_bytes(max_changed_bytes == 0 ? 1 : max_changed_bytes) {}
};

// Limits that depend on samples' size alone: 64 of them, or fewer so that their raw bytes stay within `block_bytes` (21
// of 1080p in colour), never less than one. Such blocks lie where they do whatever the samples hold: it is what a
// stream needs, whose blocks are planned before they are read.
[[nodiscard]] std::uint32_t default_block_samples(const CaptureFormat& capture,
                                                  std::uint64_t block_bytes = kDefaultBlockBytes);

// Limits that follow the content, for a file: 64 samples, fewer where changes come to 128 MiB (23 of 1080p in which
// everything changes, 64 of a still scene of any size), or where a block may come to more than `block_bytes`. Where a
// camera's noise is known they depend on samples' size alone: means are those of a block's samples, and what is held
// must not change with what else there is in the picture.
[[nodiscard]] BlockLimits default_block_limits(const CaptureFormat& source,
                                               std::uint64_t block_bytes = ~std::uint64_t{0});

class BlockBuilder {
 public:
  // `source` is what samples are; payloads are in held_format(source). Throws UsageError where a block of so
  // many samples, or the payload that it may come to, is too large, or the noise is that of other codes. Samples are
  // compared on at most `threads`; blocks are the same with any number.
  BlockBuilder(const CaptureFormat& source, const BlockLimits& limits, TilePolicy policy,
               std::uint32_t threads = ~std::uint32_t{0});
  ~BlockBuilder();
  BlockBuilder(BlockBuilder&&) noexcept;
  BlockBuilder& operator=(BlockBuilder&&) noexcept;

  // Adds the next sample: CaptureFormat::sample_bytes() bytes, codes of native byte order. Throws
  // InputError where a code is above the white code, std::logic_error where the block is full.
  void add(std::span<const std::byte> raster);
  // The next samples, of which the block has room() for as many: faster than one by one.
  void add(std::span<const std::span<const std::byte>> rasters);
  static constexpr std::uint32_t kSamplesAtOnce = 4;  // no more are compared in one go

  // Whether a sample within a block can be told by what changes in it: it takes no longer then than that is much. Not
  // where a camera's noise is known, nor where all tiles are to be dense.
  [[nodiscard]] bool takes_changes() const;
  // Adds the next sample, which is not the block's first: the one before it with these pixels changed; of several
  // changes of a pixel the last counts. The block is the same as if the sample had been added whole. Throws as add()
  // does.
  void add_changes(std::span<const PixelChange> changes);

  // How many more samples the block surely takes: none where it is full. It may take others after those.
  [[nodiscard]] std::uint32_t room() const;
  [[nodiscard]] bool is_full() const { return room() == 0; }
  [[nodiscard]] bool is_empty() const;

  // Which samples the current block holds so far.
  [[nodiscard]] BlockExtent extent() const;

  // Closes the current block (which must hold a sample). It was built where it lies, with room between its bodies:
  // `into` is given that memory and what it held before is used for the next block. Throws
  // Cancelled where a stop is asked for while what noisy samples stand for is found, which takes long.
  FinishedBlock finish(PageBuffer& into, const std::stop_token& stop = {});

  // Memory for the next block, which has not begun; what is too small is enlarged then, what is empty is not taken.
  void build_in(PageBuffer memory);

  // Takes a sample between blocks (the current one is empty) that will not be kept: only what it leaves
  // held counts.
  void pass(std::span<const std::byte> raster);

 private:
  class Implementation;
  class Comparing;
  class Averaging;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace nutik
