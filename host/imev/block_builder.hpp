// Builds blocks from samples, one after another.
//
//   in:      samples as interleaved rasters, in time order
//   out:     a block's payload each time it is full or the capture ends (layout: imev/block.hpp)
//   always:  memory for one block besides those handed out, whatever the capture's length. With a tolerance the
//            codes held at a block's end go over into the next, so that blocks change nothing about what is a
//            change; with a camera's noise each block stands on its own samples (imev/expected_values.hpp)
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "capture/picture.hpp"
#include "imev/block.hpp"
#include "imev/tile_cost.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

inline constexpr std::uint32_t kDefaultBlockSamples = 64;
inline constexpr std::uint32_t kLargestBlockSamples = 65'535;  // an index has two bytes at most
inline constexpr std::uint64_t kLargestPayloadBytes =          // a tile's offset has 32 bits
    (std::uint64_t{1} << 32) * kBlockAlignment;
inline constexpr std::uint64_t kDefaultBlockBytes = 128ull << 20;

// The samples a block holds where nothing else is asked for: 64, or fewer so that the samples' raw bytes
// stay within `block_bytes` (21 of 1080p in colour), never less than one.
[[nodiscard]] std::uint32_t default_block_samples(const CaptureFormat& capture,
                                                  std::uint64_t block_bytes = kDefaultBlockBytes);

class BlockBuilder {
 public:
  // `source` is what samples are; payloads are in held_format(source). Throws UsageError where a block of so
  // many samples, or the payload that it may come to, is too large, or the noise is that of other codes.
  BlockBuilder(const CaptureFormat& source, std::uint32_t block_samples, TilePolicy policy);
  ~BlockBuilder();
  BlockBuilder(BlockBuilder&&) noexcept;
  BlockBuilder& operator=(BlockBuilder&&) noexcept;

  // Adds the next sample: CaptureFormat::sample_bytes() bytes, codes of native byte order. Throws
  // InputError where a code is above the white code, std::logic_error where the block is full.
  void add(std::span<const std::byte> raster);
  // The next samples, of which the block has room() for as many: faster than one by one.
  void add(std::span<const std::span<const std::byte>> rasters);
  static constexpr std::uint32_t kSamplesAtOnce = 4;  // no more are compared in one go

  [[nodiscard]] std::uint32_t room() const;
  [[nodiscard]] bool is_full() const { return room() == 0; }
  [[nodiscard]] bool is_empty() const;

  // Which samples the current block holds so far.
  [[nodiscard]] BlockExtent extent() const;

  // Closes the current block (which must hold a sample). It was built where it lies, with room between its bodies:
  // `into` is given that memory and what it held before is used for the next block.
  FinishedBlock finish(PageBuffer& into);

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
