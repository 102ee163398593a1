// Random soft masks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "exposure/mask.hpp"
#include "render/render_plan.hpp"
#include "support/random_case.hpp"

namespace nutik::test {

// Whole shares of `count` names, none 0, drawn as one cuts a stick.
inline std::vector<Share> random_shares(Random& random, std::vector<std::uint8_t> names) {
  std::vector<std::int64_t> cuts{0, kWholeShare};
  while (cuts.size() <= names.size()) {
    // Half of all cuts lie at an end: shares of 1.
    const std::int64_t cut = random.chance(0.5)   ? random.whole(1, kWholeShare - 1)
                             : random.chance(0.5) ? random.whole(1, 3)
                                                  : random.whole(kWholeShare - 3, kWholeShare - 1);
    if (std::ranges::find(cuts, cut) == cuts.end()) cuts.push_back(cut);
  }
  std::ranges::sort(cuts);
  std::ranges::sort(names);
  std::vector<Share> shares;
  for (std::size_t i = 0; i < names.size(); ++i) {
    shares.push_back({names[i], static_cast<std::uint16_t>(cuts[i + 1] - cuts[i])});
  }
  return shares;
}

// Mixes the functions in some of a hard mask's pixels: a patch that ends within tiles, and one pixel in ten of the
// rest. With a single function there is nothing to mix, so it gets a second one.
inline void soften(Mask& mask, FunctionSet& functions, std::uint64_t seed) {
  Random random(seed * 77 + 5);
  if (functions.size() == 1) {
    functions.emplace(static_cast<std::uint8_t>(functions.begin()->first ^ 1),
                      GainFunction({{0, -0.5}, {1'000'000, 2.0}}));
  }
  std::vector<std::uint8_t> tags;
  for (const auto& [tag, function] : functions) tags.push_back(tag);
  for (std::uint64_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    const bool is_in_patch = pixel % mask.width < mask.width / 2 + 1 && pixel / mask.width >= mask.height / 3;
    if (!random.chance(is_in_patch ? 0.8 : 0.1)) continue;
    std::vector<std::uint8_t> names = tags;
    const auto count = static_cast<std::size_t>(
        random.whole(2, static_cast<std::int64_t>(std::min<std::size_t>(names.size(), 5))));
    while (names.size() > count) {
      names.erase(names.begin() + random.whole(0, static_cast<std::int64_t>(names.size()) - 1));
    }
    const std::vector<Share> shares = random_shares(random, names);
    mask.mixed.add(pixel, shares);
    mask.tags[pixel] = static_cast<std::uint8_t>(std::ranges::max_element(shares, {}, &Share::size)->of);
  }
}

}  // namespace nutik::test
