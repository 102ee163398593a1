// How much memory a session may use, and the shares of its parts.
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

  // For gain tables that several plans share.
  [[nodiscard]] std::uint64_t table_bytes() const { return bytes / 32; }
  // For blocks that a device reads.
  [[nodiscard]] std::uint64_t rendering_bytes() const { return bytes / 2; }

  friend bool operator==(const MemoryBudget&, const MemoryBudget&) = default;
};

// How many finished pictures may wait to be written: 64 MB of them, at least one and at most four.
[[nodiscard]] inline std::uint32_t waiting_pictures(std::uint64_t picture_bytes) {
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>((64 << 20) / picture_bytes, 1, 4));
}

// Memory that follows from a capture's format.
using NeedsOfFormat = std::function<MemoryNeeds(const CaptureFormat& capture)>;

// Memory for two copies of a mask: the one in use and the one before. Every rendering needs it.
[[nodiscard]] MemoryNeeds mask_needs(const CaptureFormat& capture);

// The least memory that renders a picture with `function_count` functions from blocks of `block_samples`.
[[nodiscard]] MemoryNeeds rendering_needs(const CaptureFormat& capture, ValueType type,
                                          std::uint64_t function_count, std::uint64_t block_samples);

}  // namespace nutik
