// Decodes a clip on a thread of its own, some samples ahead of whoever uses them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <limits>
#include <optional>
#include <span>

#include "media/clip.hpp"
#include "system/channel.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

class ReadAhead {
 public:
  static constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();

  // Decodes up to `ahead_bytes` of samples ahead (two samples at least), and no more than `most` of them.
  // `clip` must outlive this, and nobody else may read from it.
  explicit ReadAhead(Clip& clip, std::uint64_t ahead_bytes, std::uint64_t most = kAll);
  // Stops decoding.
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  // The next sample, until the next call; empty at the clip's end, or after `most`. Throws what the clip
  // threw.
  [[nodiscard]] std::span<const std::byte> next();

 private:
  void decode(std::uint64_t most);

  Clip& clip_;
  std::uint64_t sample_bytes_;
  // Rasters on pages of their own, so that decoders may write whole vectors.
  Channel<PageBuffer> decoded_;
  Channel<PageBuffer> spare_;
  std::optional<PageBuffer> current_;
  std::future<void> decoding_;
};

}  // namespace nutik
