// Shares of a pixel as whole numbers that add up to kWholeShare.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "exposure/mask.hpp"

namespace nutik {

// What each tag shall have, in parts of what all have together: at least one that is not 0. Each is rounded down, and
// what is left goes to those that lost most, of equals to the lowest tag. None that is 0 remains.
inline std::vector<Share> whole_shares(const std::array<double, kMaskValues>& wanted) {
  const double all = std::accumulate(wanted.begin(), wanted.end(), 0.0);
  std::vector<Share> shares;
  std::vector<std::pair<double, std::size_t>> lost;
  std::uint32_t left = kWholeShare;
  for (std::size_t tag = 0; tag < kMaskValues; ++tag) {
    if (wanted[tag] == 0.0) continue;
    const double share = wanted[tag] / all * kWholeShare;
    const double whole = std::min(std::floor(share), static_cast<double>(left));
    lost.emplace_back(whole - share, shares.size());  // the most negative first
    shares.push_back({static_cast<std::uint8_t>(tag), static_cast<std::uint16_t>(whole)});
    left -= shares.back().size;
  }
  std::ranges::sort(lost);
  for (std::size_t i = 0; left > 0; i = (i + 1) % lost.size(), --left) ++shares[lost[i].second].size;
  std::erase_if(shares, [](const Share& share) { return share.size == 0; });
  return shares;
}

// Gives a mask's pixel what it has: one tag, or a mixture of them.
inline void put_shares(Mask& mask, std::uint64_t pixel, const std::vector<Share>& shares) {
  mask.tags[pixel] = static_cast<std::uint8_t>(std::ranges::max_element(shares, {}, &Share::size)->of);
  if (shares.size() > 1) mask.mixed.add(pixel, shares);
}

}  // namespace nutik
