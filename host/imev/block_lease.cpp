#include "imev/block_lease.hpp"

#include <cstring>

#include "imev/payload_parts.hpp"

namespace nutik {

BlockLease BlockLease::spread(const BlockExtent& extent, std::span<const std::byte> payload,
                              std::uint64_t bytes, std::shared_ptr<const void> keeper) {
  BlockLease lease(extent, payload, std::move(keeper));
  lease.bytes_ = bytes;
  return lease;
}

BlockLease BlockLease::within(const BlockExtent& extent, std::span<const std::byte> region,
                              std::uint64_t offset, std::uint64_t bytes) {
  BlockLease lease(extent, region.subspan(offset, bytes));
  lease.region_ = region;
  lease.region_offset_ = offset;
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
