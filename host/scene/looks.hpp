// Samples spread evenly over a capture, for what need not look at all of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "imev/each_block.hpp"

namespace nutik {

class Looks {
 public:
  static constexpr std::uint64_t kMost = 256;

  explicit Looks(std::uint64_t sample_count)
      : samples_(sample_count), count_(std::min(sample_count, kMost)) {}

  [[nodiscard]] std::uint64_t count() const { return count_; }
  // Increasing, from 0 on.
  [[nodiscard]] std::uint64_t sample(std::uint64_t look) const { return look * samples_ / count_; }
  // The last look at a sample or before it.
  [[nodiscard]] std::uint64_t before(std::uint64_t sample) const {
    return ((sample + 1) * count_ - 1) / samples_;
  }

 private:
  std::uint64_t samples_, count_;
};

// Calls visit(look, raster) for each, in time order. Throws InputError where the capture is damaged.
template <typename Visit>
void for_each_look(CaptureSource& capture, const Looks& looks, Visit visit) {
  std::vector<std::byte> raster(capture.format().sample_bytes());
  std::uint64_t look = 0;
  for_each_block(capture, [&](const BlockView& block) {
    for (; look < looks.count() && looks.sample(look) < block.extent().range().last; ++look) {
      block.read_sample(static_cast<std::uint32_t>(looks.sample(look) - block.extent().first_sample), raster);
      visit(look, std::span<const std::byte>(raster));
    }
  });
}

}  // namespace nutik
