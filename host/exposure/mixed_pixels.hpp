// Pixels that several gain functions share: the soft part of a mask.
//
//   always:  pixels come in increasing order. Each has the shares of two functions or more, by increasing name, none
//            of them 0, that add up to kWholeShare exactly. So equal mixtures are equal values
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace nutik {

// What all shares of a pixel add up to.
inline constexpr std::uint32_t kWholeShare = 65'535;

struct Share {
  std::uint16_t of = 0;    // a region: its tag in a mask, its index in a plan's map (render/mask_map.hpp)
  std::uint16_t size = 0;  // of kWholeShare

  friend bool operator==(const Share&, const Share&) = default;
};

class MixedPixels {
 public:
  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] std::span<const std::uint64_t> pixels() const { return pixels_; }

  // Those of the i-th of pixels().
  [[nodiscard]] std::span<const Share> shares(std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : ends_[i - 1];
    return std::span(shares_).subspan(first, ends_[i] - first);
  }
  // Those of a pixel of the picture; none where it has one function alone.
  [[nodiscard]] std::span<const Share> of(std::uint64_t pixel) const {
    const auto found = std::ranges::lower_bound(pixels_, pixel);
    if (found == pixels_.end() || *found != pixel) return {};
    return shares(static_cast<std::size_t>(found - pixels_.begin()));
  }
  // How many functions a pixel has at most; 1 where none is mixed.
  [[nodiscard]] std::size_t max_functions() const { return max_functions_; }
  [[nodiscard]] std::uint64_t bytes() const {
    return pixels_.size() * (sizeof(std::uint64_t) + sizeof(std::size_t)) + shares_.size() * sizeof(Share);
  }

  // Behind all that were added.
  void add(std::uint64_t pixel, std::span<const Share> shares) {
    std::uint64_t sum = 0;
    for (const Share& share : shares) sum += share.size;
    const bool is_mixture =
        shares.size() > 1 && sum == kWholeShare &&
        std::ranges::none_of(shares, [](const Share& share) { return share.size == 0; }) &&
        std::ranges::is_sorted(shares, std::ranges::less_equal(), &Share::of);
    if (!is_mixture || (!pixels_.empty() && pixel <= pixels_.back())) {
      throw std::logic_error("shares of a pixel are no mixture, or come out of order");
    }
    pixels_.push_back(pixel);
    shares_.insert(shares_.end(), shares.begin(), shares.end());
    ends_.push_back(shares_.size());
    max_functions_ = std::max(max_functions_, shares.size());
  }

  // The same mixtures of things with other names, name(name before, pixel), which must be in the same order.
  template <typename Name>
  [[nodiscard]] MixedPixels renamed(Name name) const {
    MixedPixels renamed = *this;
    for (std::size_t i = 0, share = 0; i < pixels_.size(); ++i)
      for (; share < ends_[i]; ++share) renamed.shares_[share].of = name(shares_[share].of, pixels_[i]);
    return renamed;
  }

  friend bool operator==(const MixedPixels&, const MixedPixels&) = default;

 private:
  std::vector<std::uint64_t> pixels_;  // row by row
  std::vector<std::size_t> ends_;      // of each pixel's shares
  std::vector<Share> shares_;
  std::size_t max_functions_ = 1;
};

}  // namespace nutik
