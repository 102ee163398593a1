// Samples spread evenly over a capture, for what need not look at all of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"

namespace nutik {

class Looks {
 public:
  static constexpr std::uint64_t kMax = 256, kFew = 128;

  // All samples if there are few, else every other one, up to kMax.
  explicit Looks(std::uint64_t sample_count)
      : Looks(sample_count, std::clamp(sample_count / 2, kFew, kMax)) {}
  Looks(std::uint64_t sample_count, std::uint64_t most)
      : samples_(sample_count), count_(std::min(sample_count, most)) {}

  [[nodiscard]] std::uint64_t count() const { return count_; }
  // Increasing, from 0 on.
  [[nodiscard]] std::uint64_t sample(std::uint64_t look) const { return look * samples_ / count_; }
  // The look's sample, or the number of samples behind the last look.
  [[nodiscard]] std::uint64_t sample_or_end(std::uint64_t look) const {
    return look < count_ ? sample(look) : samples_;
  }
  // The first look at a sample or after it; count() where there is none.
  [[nodiscard]] std::uint64_t from(std::uint64_t sample) const {
    return sample == 0 ? 0 : before(sample - 1) + 1;
  }
  // The last look at a sample or before it.
  [[nodiscard]] std::uint64_t before(std::uint64_t sample) const {
    return ((sample + 1) * count_ - 1) / samples_;
  }

 private:
  std::uint64_t samples_, count_;
};

// A sample that is looked at.
struct Look {
  std::uint64_t number;
  const SampleCursor& held;                // there
  std::span<const std::uint32_t> changed;  // tiles that may hold others than at the look before
};

// Calls visit(Look) for each, in time order. Throws InputError where the capture is damaged.
template <typename Visit>
void for_each_look(CaptureSource& capture, const Looks& looks, Visit visit) {
  std::uint64_t look = 0;
  for_each_block(capture, [&](const BlockView& block) {
    SampleCursor cursor(capture.format().shape, block);
    for (; look < looks.count() && looks.sample(look) < block.extent().range().last; ++look) {
      const auto changed =
          cursor.go_to(static_cast<std::uint32_t>(looks.sample(look) - block.extent().first_sample));
      visit(Look{look, cursor, changed});
    }
  });
}

}  // namespace nutik
