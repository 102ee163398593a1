// Where a renderer gets a capture from: its format, its timeline, and its blocks on loan.
//
// A source may be a .tik file, a capture in memory, or a clip that is decoded while it is rendered. Format, timeline
// and extents may be asked for by any thread at any time; each source says how blocks may be acquired.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "imev/block.hpp"
#include "imev/block_builder.hpp"
#include "imev/block_lease.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

class CaptureSource {
 public:
  virtual ~CaptureSource() = default;

  [[nodiscard]] virtual const CaptureFormat& format() const = 0;
  [[nodiscard]] virtual const Timeline& timeline() const = 0;
  [[nodiscard]] virtual std::uint64_t block_count() const = 0;
  [[nodiscard]] virtual BlockExtent block_extent(std::uint64_t block) const = 0;
  // Whether each block is acquired once at most, in increasing order, by one thread at a time. Else by any number of
  // threads, different ones or the same, in any order.
  [[nodiscard]] virtual bool is_forward_only() const { return false; }

  // A block's payload, checked; empty only where terms.room had none. Throws InputError where it is damaged.
  [[nodiscard]] BlockLease acquire(std::uint64_t block, const LeaseTerms& terms = {}) {
    return lend(block, terms);
  }

  // Throws InputError where what was lent may have changed meanwhile.
  virtual void check_unchanged() const {}

  // What a block's payload takes in memory while it is on loan, at most: nothing where it lies in memory anyway.
  [[nodiscard]] virtual std::uint64_t lent_bytes(std::uint64_t /*block*/) const { return 0; }

  // Whether acquire() will check all of a block that lies in memory, for the first time.
  [[nodiscard]] virtual bool is_unchecked(std::uint64_t /*block*/) const { return false; }

  // Does ahead what acquire() will take time for, while whoever will ask for the block is not ready yet. A source
  // may do nothing. Any thread may ask, besides those that acquire.
  virtual void preload(std::uint64_t /*block*/) {}

 private:
  virtual BlockLease lend(std::uint64_t block, const LeaseTerms& terms) = 0;
};

// A capture held in memory, block by block.
class MemoryCapture final : public CaptureSource {
 public:
  // `rasters` are the samples in order, of the format `source` and as many as the timeline has.
  MemoryCapture(const CaptureFormat& source, Timeline timeline,
                std::span<const std::vector<std::byte>> rasters, const BlockLimits& limits,
                TilePolicy policy = TilePolicy::automatic);

  [[nodiscard]] const CaptureFormat& format() const override { return capture_; }
  [[nodiscard]] const Timeline& timeline() const override { return timeline_; }
  [[nodiscard]] std::uint64_t block_count() const override { return blocks_.size(); }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t block) const override { return blocks_[block].extent; }

  [[nodiscard]] BlockView view(std::uint64_t block) const;

 private:
  BlockLease lend(std::uint64_t block, const LeaseTerms& terms) override;

  struct Block {
    BlockExtent extent;
    PageBuffer payload;
    std::uint64_t bytes;
  };

  CaptureFormat capture_;
  Timeline timeline_;
  std::vector<Block> blocks_;
};

// Thrown where a stream turns out to have another number of samples than its timeline.
struct SampleCountMismatch : InputError {
  std::uint64_t sample_count;  // that there really are

  SampleCountMismatch(std::uint64_t found, std::uint64_t expected);
};

// What a StreamingCapture reads of `sample_count` samples: none after those that are needed; but where the
// camera's noise is known, samples stand for others of their block, and the last block is read to its end.
[[nodiscard]] SampleRange streamed_samples(const CaptureFormat& source, SampleRange needed,
                                           std::uint32_t block_samples, std::uint64_t sample_count);

// A capture that is built while it is read, from a stream of samples of the format `source`. Nothing outside
// streamed_samples() is kept, nothing after it is read.
class StreamingCapture final : public CaptureSource {
 public:
  // The next samples, at most so many and at least one, as interleaved rasters that stay until the next call;
  // none at the end.
  using NextSamples = std::function<std::span<const std::span<const std::byte>>(std::uint64_t most)>;

  StreamingCapture(const CaptureFormat& source, Timeline timeline, SampleRange needed,
                   std::uint32_t block_samples, TilePolicy policy, NextSamples next_samples);

  [[nodiscard]] const CaptureFormat& format() const override { return capture_; }
  [[nodiscard]] const Timeline& timeline() const override { return timeline_; }
  // Blocks lie where they would in a file of the whole capture; the last one may be cut short.
  [[nodiscard]] std::uint64_t block_count() const override;
  [[nodiscard]] BlockExtent block_extent(std::uint64_t block) const override;

  [[nodiscard]] bool is_forward_only() const override { return true; }

 private:
  // Memory that was lent and came back, from whatever thread.
  class SparePayloads;

  // Builds the block; its memory is the lease's as long as that lives, and then that of a later block. Throws
  // SampleCountMismatch where the stream ends too early, or goes on after the timeline's end.
  BlockLease lend(std::uint64_t block, const LeaseTerms& terms) override;
  void read_samples(std::uint64_t until, bool keep);

  CaptureFormat capture_;
  Timeline timeline_;
  SampleRange needed_;
  std::uint32_t block_samples_;
  NextSamples next_samples_;
  BlockBuilder builder_;
  std::uint64_t samples_read_ = 0;
  std::shared_ptr<SparePayloads> spares_;
};

}  // namespace nutik
