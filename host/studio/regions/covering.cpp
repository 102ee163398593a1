#include "studio/regions/covering.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "studio/regions/region_edits.hpp"

namespace nutik::studio {
namespace {

// Calls `visit` with each pixel inside. Most of a stroke's region is empty.
template <typename Visit>
void for_each_inside(const Region& region, const Visit& visit) {
  const std::uint8_t *begin = region.inside.data(), *end = begin + region.inside.size();
  for (const std::uint8_t* at = begin; at != end; ++at) {
    at = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)));
    if (at == nullptr) return;
    visit(static_cast<std::size_t>(at - begin));
  }
}

std::array<int, kMaskValues> ranks_of(const std::vector<std::uint8_t>& order) {
  std::array<int, kMaskValues> ranks{};
  ranks.fill(static_cast<int>(kMaskValues));  // the background is behind all
  for (std::size_t place = 0; place < order.size(); ++place) ranks[order[place]] = static_cast<int>(place);
  return ranks;
}

}  // namespace

Covering::Covering(const Document& document) : state_(document.state()) {
  const Shape& shape = document.facts()->format.shape;
  mask_ = state_.mask ? (*state_.mask)->mask : Mask::uniform(shape.width, shape.height, kBackground);
  rank();
}

void Covering::rank() { rank_ = ranks_of(state_.order); }

const Region* Covering::covered_now(std::uint8_t tag) const {
  if (const auto found = changed_.find(tag); found != changed_.end()) return &found->second;
  const auto found = state_.covered.find(tag);
  return found == state_.covered.end() ? nullptr : &*found->second;
}

Region& Covering::covered(std::uint8_t tag) {
  const auto found = changed_.find(tag);
  if (found != changed_.end()) return found->second;
  const Region* now = covered_now(tag);
  return changed_.emplace(tag, now != nullptr ? *now : Region::none(mask_.width, mask_.height)).first->second;
}

Region Covering::area_of(std::uint8_t tag) const {
  const Region* beneath = covered_now(tag);
  Region area = beneath != nullptr ? *beneath : Region::none(mask_.width, mask_.height);
  for (std::size_t pixel = 0; pixel < area.inside.size(); ++pixel)
    if (mask_.tags[pixel] == tag) area.inside[pixel] = 1;
  return area;
}

void Covering::give(const Region& pixels, std::uint8_t tag) {
  for_each_inside(pixels, [&](std::size_t pixel) {
    const std::uint8_t owner = mask_.tags[pixel];
    if (owner == tag) return;
    if (is_before(owner, tag)) {
      covered(tag).inside[pixel] = 1;
    } else {
      if (owner != kBackground) covered(owner).inside[pixel] = 1;
      mask_.tags[pixel] = tag;
    }
  });
}

void Covering::take(const Region& pixels, std::uint8_t tag) {
  const bool has_covered = covered_now(tag) != nullptr;
  for_each_inside(pixels, [&](std::size_t pixel) {
    if (has_covered) covered(tag).inside[pixel] = 0;
    if (mask_.tags[pixel] == tag) lose(pixel);
  });
}

void Covering::take_from_all(const Region& pixels) {
  for (const std::uint8_t tag : state_.order)
    if (covered_now(tag) != nullptr) take(pixels, tag);
  paint(mask_, pixels, kBackground);
}

void Covering::lose(std::size_t pixel) {
  mask_.tags[pixel] = kBackground;
  for (const std::uint8_t tag : state_.order) {
    const Region* beneath = covered_now(tag);
    if (beneath == nullptr || beneath->inside[pixel] == 0) continue;
    covered(tag).inside[pixel] = 0;
    mask_.tags[pixel] = tag;
    return;
  }
}

bool Covering::move_up(std::uint8_t tag) {
  const auto place = std::ranges::find(state_.order, tag);
  if (place == state_.order.end() || place == state_.order.begin()) return false;
  const std::uint8_t before = *(place - 1);
  std::iter_swap(place, place - 1);
  rank();
  if (covered_now(tag) == nullptr) return true;
  for (std::size_t pixel = 0; pixel < mask_.tags.size(); ++pixel) {
    if (mask_.tags[pixel] != before || covered_now(tag)->inside[pixel] == 0) continue;
    covered(tag).inside[pixel] = 0;
    covered(before).inside[pixel] = 1;
    mask_.tags[pixel] = tag;
  }
  return true;
}

DocumentState Covering::state() && {
  for (auto& [tag, region] : changed_) {
    state_.covered.erase(tag);
    if (region.pixel_count() > 0) state_.covered.emplace(tag, Shared(std::move(region)));
  }
  state_.mask = Shared(MaskWithRegions(std::move(mask_)));
  return std::move(state_);
}

void tidy_covered(DocumentState& state) {
  const auto ranks = ranks_of(state.order);
  std::map<std::uint8_t, Shared<Region>> tidied;
  for (const auto& [tag, shared] : state.covered) {
    Region region = *shared;
    const std::vector<std::uint8_t>& owners = (*state.mask)->mask.tags;
    for (std::size_t pixel = 0; pixel < owners.size(); ++pixel)
      if (ranks[owners[pixel]] >= ranks[tag]) region.inside[pixel] = 0;
    if (region.pixel_count() > 0) tidied.emplace(tag, Shared(std::move(region)));
  }
  state.covered = std::move(tidied);
}

}  // namespace nutik::studio
