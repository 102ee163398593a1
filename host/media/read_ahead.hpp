// Decodes a clip on a thread of its own, some samples ahead of whoever uses them.
//
//   in:      a clip that nobody else reads
//   out:     its samples, each once, in their order
//   always:  an error of the clip comes up behind the last sample before it, at next()
#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "media/clip.hpp"
#include "system/channel.hpp"

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
  using Raster = std::vector<std::byte>;

  void decode(std::uint64_t most);

  Clip& clip_;
  Channel<Raster> decoded_;
  Channel<Raster> spare_;
  std::optional<Raster> current_;
  std::future<void> decoding_;
};

}  // namespace nutik
