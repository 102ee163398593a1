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
#include <span>
#include <vector>

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

  // The next samples, until the next call: at most so many, and at least one as long as there is one; fewer than
  // asked at the clip's end, after `most`, or where that would leave nothing to decode into. Throws what the clip
  // threw.
  [[nodiscard]] std::span<const std::span<const std::byte>> next(std::uint64_t most);

 private:
  void decode(std::uint64_t most);

  Clip& clip_;
  std::uint64_t sample_bytes_;
  std::size_t raster_count_;
  // Rasters on pages of their own, so that decoders may write whole vectors.
  Channel<PageBuffer> decoded_;
  Channel<PageBuffer> spare_;
  std::vector<PageBuffer> current_;
  std::vector<std::span<const std::byte>> rasters_;  // of these
  std::future<void> decoding_;
};

}  // namespace nutik
