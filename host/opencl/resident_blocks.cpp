#include "opencl/resident_blocks.hpp"

#include <algorithm>

namespace nutik {

const BlockPlace* ResidentBlocks::find(std::uint64_t block) const {
  const auto found = places_.find(block);
  return found == places_.end() ? nullptr : &found->second;
}

void ResidentBlocks::clear() {
  places_.clear();
  slabs_.clear();
  bytes_ = 0;
}

void ResidentBlocks::begin(std::span<const PlannedBlock> needed, std::uint64_t max_bytes) {
  max_bytes_ = max_bytes;
  ++exposure_;
  if (places_.empty()) return;
  for (const PlannedBlock& planned : needed) {
    const auto found = places_.find(planned.block);
    if (found != places_.end()) found->second.slab->exposure = exposure_;
  }
  while (bytes_ > max_bytes_) drop(std::ranges::min_element(slabs_, {}, &Slab::exposure));
}

void ResidentBlocks::drop(std::list<Slab>::iterator slab) {
  std::erase_if(places_, [&](const auto& place) { return place.second.slab == &*slab; });
  bytes_ -= slab->capacity;
  slabs_.erase(slab);
}

bool ResidentBlocks::drop_others(std::uint64_t bytes) {
  if (bytes > max_bytes_) return false;
  while (bytes_ + bytes > max_bytes_) {
    const auto oldest = std::ranges::min_element(slabs_, {}, &Slab::exposure);
    if (oldest == slabs_.end() || oldest->exposure == exposure_) return false;
    drop(oldest);
  }
  return true;
}

}  // namespace nutik
