// The pairs of a mask value and a delay that occur in a picture: each is a region of its own (render/mask_map.hpp).
//
//   always:  takes 1.5 bits for each pair that could occur, 3 MB at most, and nothing for each pixel
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "exposure/delay_map.hpp"
#include "exposure/mask.hpp"

namespace nutik {

class DelayedPairs {
 public:
  // Throws InputError where mask and delays have different sizes, or more pairs of both occur than there can be
  // regions.
  DelayedPairs(const Mask& mask, const DelayMap& delays);

  [[nodiscard]] std::size_t count() const { return count_; }

  // By mask value, then delay. `delay` counts the map's delays; the pair must be one that occurs.
  [[nodiscard]] std::uint16_t number_of(std::uint8_t tag, std::uint16_t delay) const {
    const std::size_t word = first_word_of_tag_[tag] + delay / kBits;
    const std::uint64_t lower = (std::uint64_t{1} << delay % kBits) - 1;
    return static_cast<std::uint16_t>(before_[word] + static_cast<std::uint32_t>(std::popcount(words_[word] & lower)));
  }

 private:
  static constexpr std::size_t kBits = 64;

  std::array<std::size_t, kMaskValues> first_word_of_tag_{};
  std::vector<std::uint64_t> words_;   // a bit for each delay, of one mask value after another
  std::vector<std::uint32_t> before_;  // pairs in the words before each
  std::size_t count_ = 0;
};

// Calls visit(pixel, tag) for each mask value that has a share of a pixel, pixel by pixel.
template <typename Visit>
void for_each_share(const Mask& mask, Visit visit) {
  std::size_t mixed = 0;
  for (std::uint64_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    if (mixed == mask.mixed.pixels().size() || mask.mixed.pixels()[mixed] != pixel) {
      visit(pixel, mask.tags[pixel]);
      continue;
    }
    for (const Share& share : mask.mixed.shares(mixed)) visit(pixel, static_cast<std::uint8_t>(share.of));
    ++mixed;
  }
}

}  // namespace nutik
