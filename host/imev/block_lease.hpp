// A block's payload as files hold it, and on loan from its source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "imev/block.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

// A payload as files hold it.
//
//   in:      a payload in memory, whose bodies may lie apart
//   out:     its parts in the order of files: a directory for bodies that lie one behind the other, then those
//            bodies, not copied; neighbours in memory are one part
class PayloadParts {
 public:
  // `payload` must outlive this.
  PayloadParts(const BlockGeometry& geometry, std::span<const std::byte> payload);
  PayloadParts(const PayloadParts&) = delete;
  PayloadParts& operator=(const PayloadParts&) = delete;

  [[nodiscard]] std::span<const std::span<const std::byte>> parts() const { return parts_; }
  // All parts together.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  // Writes them one behind the other to `into`, which has at least as many bytes.
  void copy_to(std::span<std::byte> into) const;

 private:
  std::vector<std::byte> directory_;
  std::vector<std::span<const std::byte>> parts_;
  std::uint64_t bytes_;
};

// Gives memory for a payload of so many bytes or more, which begins at a multiple of 64 bytes and is not written to
// while the lease lives. An empty span: there is none, and the block is not wanted now.
using AllocatePayload = std::function<std::span<std::byte>(std::uint64_t bytes)>;

// Tells whether any of the tiles [first, last) of a block is wanted.
using WantsTiles = std::function<bool(std::uint64_t first, std::uint64_t last)>;

// What whoever acquires a block has to say about it.
struct LeaseTerms {
  // A source that has to unpack the payload calls this once, before any slow work; one that has the payload in memory
  // does not. Without it a payload is unpacked into memory of the source's own.
  AllocatePayload room = {};

  // A source that unpacks tiles in groups calls this after `room`, once for each group, in their order. Where a group
  // is not wanted, the memory of its bodies stays as it was; the directory is always whole. Without it all are wanted.
  WantsTiles wants = {};
};

// A payload on loan.
//
//   always:  the payload stays where it is and as it is while the lease lives, whatever else is acquired meanwhile.
//            The source must outlive its leases; any thread may end one, in any order
class BlockLease {
 public:
  // An empty one: what a source returns when there was no room.
  BlockLease() = default;

  // A payload as files hold it. `keeper` owns its memory; null where that outlives the lease anyway.
  BlockLease(const BlockExtent& extent, std::span<const std::byte> payload,
             std::shared_ptr<const void> keeper = {})
      : extent_(extent), payload_(payload), bytes_(payload.size()), keeper_(std::move(keeper)) {}

  // A payload with room between its bodies; as files hold it, it has `bytes`.
  static BlockLease spread(const BlockExtent& extent, std::span<const std::byte> payload, std::uint64_t bytes,
                           std::shared_ptr<const void> keeper);

  // A payload within memory that starts on a page border and lasts as long as the source.
  static BlockLease within(const BlockExtent& extent, std::span<const std::byte> mapping, std::uint64_t offset,
                           std::uint64_t bytes);

  BlockLease(BlockLease&&) = default;
  BlockLease& operator=(BlockLease&&) = default;

  [[nodiscard]] bool is_empty() const { return payload_.empty(); }
  [[nodiscard]] const BlockExtent& extent() const { return extent_; }
  // From a multiple of 64 bytes on.
  [[nodiscard]] std::span<const std::byte> payload() const { return payload_; }
  // What the payload takes without room between its bodies.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  // The lasting memory that the payload is part of, and where it begins there; empty where there is none.
  [[nodiscard]] std::span<const std::byte> mapping() const { return mapping_; }
  [[nodiscard]] std::uint64_t mapping_offset() const { return mapping_offset_; }

  // Writes the payload as files hold it, bytes() of them, to the front of `into`.
  void copy_to(const CaptureFormat& capture, std::span<std::byte> into) const;

 private:
  BlockExtent extent_;
  std::span<const std::byte> payload_;
  std::uint64_t bytes_ = 0;
  std::span<const std::byte> mapping_;
  std::uint64_t mapping_offset_ = 0;
  std::shared_ptr<const void> keeper_;
};

}  // namespace nutik
