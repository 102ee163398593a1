#include "imev/block_lease.hpp"

#include <cstring>

namespace nutik {

PayloadParts::PayloadParts(const BlockGeometry& geometry, std::span<const std::byte> payload)
    : directory_(geometry.directory_bytes()), parts_{directory_}, bytes_(geometry.directory_bytes()) {
  for (std::uint64_t tile = 0; tile < geometry.tile_count; ++tile) {
    TileEntry entry;
    std::memcpy(&entry, payload.data() + tile * sizeof entry, sizeof entry);
    const auto body = payload.subspan(entry.offset * kBlockAlignment, geometry.body_bytes(entry));
    entry.offset = static_cast<std::uint32_t>(bytes_ / kBlockAlignment);
    std::memcpy(directory_.data() + tile * sizeof entry, &entry, sizeof entry);
    bytes_ += body.size();
    if (std::span<const std::byte>& last = parts_.back();
        tile > 0 && last.data() + last.size() == body.data()) {
      last = {last.data(), last.size() + body.size()};
    } else {
      parts_.push_back(body);
    }
  }
}

void PayloadParts::copy_to(std::span<std::byte> into) const {
  for (const std::span<const std::byte> part : parts_) {
    std::memcpy(into.data(), part.data(), part.size());
    into = into.subspan(part.size());
  }
}

BlockLease BlockLease::spread(const BlockExtent& extent, std::span<const std::byte> payload,
                              std::uint64_t bytes, std::shared_ptr<const void> keeper) {
  BlockLease lease(extent, payload, std::move(keeper));
  lease.bytes_ = bytes;
  return lease;
}

BlockLease BlockLease::within(const BlockExtent& extent, std::span<const std::byte> mapping,
                              std::uint64_t offset, std::uint64_t bytes) {
  BlockLease lease(extent, mapping.subspan(offset, bytes));
  lease.mapping_ = mapping;
  lease.mapping_offset_ = offset;
  return lease;
}

void BlockLease::copy_to(const CaptureFormat& capture, std::span<std::byte> into) const {
  if (bytes_ == payload_.size()) {
    std::memcpy(into.data(), payload_.data(), bytes_);
  } else {
    PayloadParts(BlockGeometry(capture, extent_.sample_count), payload_).copy_to(into);
  }
}

}  // namespace nutik
