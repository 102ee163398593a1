#include "mask/mask_between.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "mask/distance.hpp"
#include "mask/whole_shares.hpp"

namespace nutik {
namespace {

void require_one_size(const Mask& a, const std::string& a_name, const Mask& b, const std::string& b_name) {
  if (a.width == b.width && a.height == b.height) return;
  throw InputError(format("{} has {} x {} pixels and {} has {} x {}; masks of key frames have one size",
                          a_name, a.width, a.height, b_name, b.width, b.height));
}

void require_places(const Mask& a, const std::string& a_name, const Mask& b, const std::string& b_name) {
  for (const auto& [mask, name] : {std::pair(&a, &a_name), std::pair(&b, &b_name)}) {
    if (mask->is_soft()) {
      throw InputError(format("{} is a soft mask, whose regions have no edges that could move; blend by alpha",
                              *name));
    }
  }
  const auto of_a = a.pixels_per_tag(), of_b = b.pixels_per_tag();
  for (std::size_t tag = 0; tag < kMaskValues; ++tag) {
    if ((of_a[tag] > 0) == (of_b[tag] > 0)) continue;
    const auto& [here, there] = of_a[tag] > 0 ? std::pair(a_name, b_name) : std::pair(b_name, a_name);
    throw InputError(format("mask value {} is in {} and not in {}: by distance a region needs a place in "
                            "both; paint a few pixels of it, or blend by alpha",
                            tag, here, there));
  }
}

// The pixels that have a tag, or those that have another.
Region region_of(const Mask& mask, std::uint8_t tag, bool has_it) {
  Region region = Region::none(mask.width, mask.height);
  for (std::size_t i = 0; i < mask.tags.size(); ++i) region.inside[i] = (mask.tags[i] == tag) == has_it;
  return region;
}

// To the edge of a tag, which lies half way between the pixels on both sides of it: positive within. A tag that has all
// pixels is as far from its edge as can be.
std::vector<double> distances_to_edge(const Mask& mask, std::uint8_t tag) {
  const auto outwards = squared_distances(region_of(mask, tag, false));
  const auto inwards = squared_distances(region_of(mask, tag, true));
  std::vector<double> distances(outwards.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    distances[i] = mask.tags[i] == tag ? std::sqrt(static_cast<double>(outwards[i])) - 0.5
                                       : 0.5 - std::sqrt(static_cast<double>(inwards[i]));
  }
  return distances;
}

Mask by_distance(const Mask& a, const Mask& b, double share) {
  Mask between = Mask::uniform(a.width, a.height, 0);
  std::vector<double> furthest(a.tags.size(), -HUGE_VAL);
  const auto counts = a.pixels_per_tag();
  for (std::size_t value = 0; value < kMaskValues; ++value) {
    if (counts[value] == 0) continue;
    const auto tag = static_cast<std::uint8_t>(value);
    const std::vector<double> from = distances_to_edge(a, tag), to = distances_to_edge(b, tag);
    for (std::size_t i = 0; i < furthest.size(); ++i) {
      const double within = (1.0 - share) * from[i] + share * to[i];
      if (within <= furthest[i]) continue;
      furthest[i] = within;
      between.tags[i] = tag;
    }
  }
  return between;
}

// Adds a pixel's shares, each so many times.
void add_shares(std::array<double, kMaskValues>& sums, const Mask& mask, std::size_t& next_mixed,
                std::uint64_t pixel, double times) {
  const auto mixed = mask.mixed.pixels();
  if (next_mixed < mixed.size() && mixed[next_mixed] == pixel) {
    for (const Share& share : mask.mixed.shares(next_mixed++)) sums[share.of] += times * share.size;
  } else {
    sums[mask.tags[pixel]] += times * kWholeShare;
  }
}

Mask by_alpha(const Mask& a, const Mask& b, std::uint32_t way) {
  Mask between = Mask::uniform(a.width, a.height, 0);
  std::size_t next_of_a = 0, next_of_b = 0;
  for (std::uint64_t pixel = 0; pixel < a.tags.size(); ++pixel) {
    std::array<double, kMaskValues> sums{};  // whole numbers below 2^32
    add_shares(sums, a, next_of_a, pixel, kWholeWay - way);
    add_shares(sums, b, next_of_b, pixel, way);
    put_shares(between, pixel, whole_shares(sums));
  }
  return between;
}

}  // namespace

Mask mask_between(const Mask& a, const std::string& a_name, const Mask& b, const std::string& b_name,
                  MaskBlend blend, std::uint32_t way) {
  require_one_size(a, a_name, b, b_name);
  if (blend == MaskBlend::distance) require_places(a, a_name, b, b_name);
  if (way == 0) return a;
  if (way >= kWholeWay) return b;
  if (blend == MaskBlend::alpha) return by_alpha(a, b, way);
  return by_distance(a, b, static_cast<double>(way) / kWholeWay);
}

}  // namespace nutik
