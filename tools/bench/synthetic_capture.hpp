// Captures made up for benchmarks: random codes in tiles of a chosen kind, in memory.
#pragma once

#include <cstdint>

#include "imev/capture_source.hpp"
#include "system/page_buffer.hpp"

namespace nutik::bench {

enum class Content {
  dense,    // every tile has a row for every sample
  rows,     // a row for every fourth sample
  records,  // each pixel changes 4 times a block, at its own times
  still     // nothing changes
};

class SyntheticCapture final : public CaptureSource {
 public:
  SyntheticCapture(const CaptureFormat& capture, std::uint64_t sample_count, std::uint32_t block_samples,
                   Content content, std::uint32_t rate = 240);

  [[nodiscard]] const CaptureFormat& format() const override { return capture_; }
  [[nodiscard]] const Timeline& timeline() const override { return timeline_; }
  [[nodiscard]] std::uint64_t block_count() const override { return blocks_.size(); }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t block) const override { return blocks_[block].extent; }
  // All blocks.
  [[nodiscard]] std::span<const std::byte> memory() const { return {memory_.data(), bytes_}; }

 private:
  BlockLease lend(std::uint64_t block, const LeaseTerms& /*terms*/) override {
    const Block& at = blocks_[block];
    return BlockLease::within(at.extent, memory(), at.offset, at.bytes);
  }

  struct Block {
    BlockExtent extent;
    std::uint64_t offset;
    std::uint64_t bytes;
  };

  CaptureFormat capture_;
  Timeline timeline_;
  std::vector<Block> blocks_;
  PageBuffer memory_;
  std::uint64_t bytes_ = 0;
};

}  // namespace nutik::bench
