// What a session may hold in memory, shared out among those who hold pictures and blocks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"

namespace nutik {

struct MemoryBudget {
  std::uint64_t bytes = 0;

  // Half of the machine's memory.
  static MemoryBudget of_machine();

  // Of tables that plans have in common.
  [[nodiscard]] std::uint64_t table_bytes() const { return bytes / 32; }
  // Of blocks where a device reads them.
  [[nodiscard]] std::uint64_t rendering_bytes() const { return bytes / 2; }

  friend bool operator==(const MemoryBudget&, const MemoryBudget&) = default;
};

// How many finished pictures of a size may wait to be written: no more than 64 MB of them, but one.
[[nodiscard]] inline std::uint32_t waiting_pictures(std::uint64_t picture_bytes) {
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>((64 << 20) / picture_bytes, 1, 4));
}

// What is held of a capture, or beside it, by its format.
using NeedsOfFormat = std::function<MemoryNeeds(const CaptureFormat& capture)>;

// Memory for two copies of a mask: the one in use and the one before. Held of every capture of this format, whatever is
// rendered of it.
[[nodiscard]] MemoryNeeds mask_needs(const CaptureFormat& capture);

// What rendering takes at the least, with tables of so many functions over a block of so many samples.
[[nodiscard]] MemoryNeeds rendering_needs(const CaptureFormat& capture, ValueType type,
                                          std::uint64_t function_count, std::uint64_t block_samples);

// The budget does not hold blocks of so many samples.
struct BlocksTooLong : UsageError {
  std::uint64_t most_samples;  // that would do

  BlocksTooLong(std::uint64_t bytes, std::uint32_t block_samples, std::uint64_t sample_bytes,
                std::uint64_t most_samples);
};

}  // namespace nutik
