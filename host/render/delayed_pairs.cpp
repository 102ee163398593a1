#include "render/delayed_pairs.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "render/mask_map.hpp"

namespace nutik {

DelayedPairs::DelayedPairs(const Mask& mask, const DelayMap& delays) {
  if (delays.width != mask.width || delays.height != mask.height) {
    throw InputError(
        format("the map of delays is {} x {} pixels and the pictures are {} x {}; it needs their size",
               delays.width, delays.height, mask.width, mask.height));
  }
  const std::size_t words_of_tag = (delays.delays_ns.size() + kBits - 1) / kBits;
  for (const MaskRegion& value : regions_of(mask)) {
    first_word_of_tag_[value.tag] = words_.size();
    words_.resize(words_.size() + words_of_tag);
  }
  for_each_share(mask, [&](std::uint64_t pixel, std::uint8_t tag) {
    const std::uint16_t delay = delays.delay_of_pixel[pixel];
    words_[first_word_of_tag_[tag] + delay / kBits] |= std::uint64_t{1} << delay % kBits;
  });
  before_.reserve(words_.size());
  for (const std::uint64_t word : words_) {
    before_.push_back(static_cast<std::uint32_t>(count_));
    count_ += static_cast<std::size_t>(std::popcount(word));
  }
  if (count_ > MaskMap::kMaxRegions) {
    throw InputError(format(
        "the mask and the map of delays make {} different pairs of a function and a delay, and there can be "
        "{}; use a map with fewer values, of 8 bits for example, or a mask with fewer",
        count_, MaskMap::kMaxRegions));
  }
}

}  // namespace nutik
