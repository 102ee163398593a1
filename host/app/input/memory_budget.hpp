// What --memory allows, shared out among those who hold pictures and blocks.
#pragma once

#include <algorithm>
#include <cstdint>

#include "app/command_line/options.hpp"
#include "capture/picture.hpp"

namespace nutik::app {

struct MemoryBudget {
  std::uint64_t bytes = 0;

  // What was stated, as 500MB, 2GB or 1GiB; else half of the machine's memory. Throws UsageError where it is no
  // size.
  static MemoryBudget from(const Options& options);

  // Of a block's samples as rasters. Encoding holds about four: one being built, one being packed, and what it is
  // packed into, in parts and whole; with a camera's noise a fifth, the samples as they came.
  [[nodiscard]] std::uint64_t block_bytes() const { return bytes / 6; }
  // Of samples decoded ahead.
  [[nodiscard]] std::uint64_t read_ahead_bytes() const {
    return std::min<std::uint64_t>(64 << 20, bytes / 8);
  }
  // Of blocks where a device reads them.
  [[nodiscard]] std::uint64_t rendering_bytes() const { return bytes / 2; }

  // Throws UsageError where a block of so many samples, or a single one, does not fit.
  void check(const CaptureFormat& capture, std::uint32_t block_samples) const;
};

}  // namespace nutik::app
