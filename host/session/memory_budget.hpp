// What a session may hold in memory, shared out among those who hold pictures and blocks.
#pragma once

#include <algorithm>
#include <cstdint>

#include "capture/error.hpp"
#include "capture/picture.hpp"

namespace nutik {

struct MemoryBudget {
  std::uint64_t bytes = 0;

  // Half of the machine's memory.
  static MemoryBudget of_machine();

  // Of a block's samples as rasters. Encoding holds about four: one being built, one being packed, and what it is
  // packed into, in parts and whole; with a camera's noise a fifth, the samples as they came.
  [[nodiscard]] std::uint64_t block_bytes() const { return bytes / 6; }
  // Of samples decoded ahead.
  [[nodiscard]] std::uint64_t read_ahead_bytes() const {
    return std::min<std::uint64_t>(64 << 20, bytes / 8);
  }
  // Of tables that plans have in common.
  [[nodiscard]] std::uint64_t table_bytes() const { return bytes / 32; }
  // Of blocks where a device reads them.
  [[nodiscard]] std::uint64_t rendering_bytes() const { return bytes / 2; }

  // Throws PicturesTooLarge or BlocksTooLong where a single sample, or a block of so many, does not fit.
  void check(const CaptureFormat& capture, std::uint32_t block_samples) const;

  friend bool operator==(const MemoryBudget&, const MemoryBudget&) = default;
};

// The budget does not hold the pictures that reading a clip needs at the least.
struct PicturesTooLarge : UsageError {
  std::uint64_t least_bytes;  // that would do

  PicturesTooLarge(std::uint64_t bytes, std::uint64_t sample_bytes, std::uint64_t sample_count);
};

// The budget does not hold blocks of so many samples.
struct BlocksTooLong : UsageError {
  std::uint64_t most_samples;  // that would do

  BlocksTooLong(std::uint64_t bytes, std::uint32_t block_samples, std::uint64_t sample_bytes,
                std::uint64_t most_samples);
};

}  // namespace nutik
