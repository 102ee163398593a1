// Where a renderer gets a capture from: its format, its timeline and its blocks, one after another.
//
// A source may be a .tik file, a capture in memory, or a clip that is decoded while it is rendered; the
// last can only go forward, so blocks are asked for in increasing order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "imev/block.hpp"
#include "imev/block_builder.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

class CaptureSource {
 public:
  virtual ~CaptureSource() = default;

  [[nodiscard]] virtual const CaptureFormat& format() const = 0;
  [[nodiscard]] virtual const Timeline& timeline() const = 0;
  [[nodiscard]] virtual std::uint64_t block_count() const = 0;
  [[nodiscard]] virtual BlockExtent block_extent(std::uint64_t block) const = 0;

  // Makes a block ready and returns its payload's bytes. Throws InputError where it is damaged.
  virtual std::uint64_t prepare(std::uint64_t block) = 0;

  // Copies the payload of the block prepared last to the front of `into`.
  virtual void read(std::uint64_t block, std::span<std::byte> into) = 0;

  // That payload where it lies, from a page border on and with room between its bodies, until prepare() has been
  // called twice more; empty where it has to be read.
  [[nodiscard]] virtual std::span<const std::byte> lent() const { return {}; }

  // Does ahead what prepare() and read() will take time for, while whoever will ask for the block is not
  // ready yet. A source may do nothing.
  virtual void preload(std::uint64_t /*block*/) {}

  // Where every payload already lies in memory, ready to be used in place: that memory, which starts on
  // a page border, and the payload's offset in it. Otherwise the region is empty.
  [[nodiscard]] virtual std::span<const std::byte> region() const { return {}; }
  [[nodiscard]] virtual std::uint64_t region_offset(std::uint64_t /*block*/) const { return 0; }
};

// A capture held in memory, block by block.
class MemoryCapture final : public CaptureSource {
 public:
  // `rasters` are the samples in order, of the format `source` and as many as the timeline has.
  MemoryCapture(const CaptureFormat& source, Timeline timeline,
                std::span<const std::vector<std::byte>> rasters, std::uint32_t block_samples,
                TilePolicy policy = TilePolicy::automatic);

  [[nodiscard]] const CaptureFormat& format() const override { return capture_; }
  [[nodiscard]] const Timeline& timeline() const override { return timeline_; }
  [[nodiscard]] std::uint64_t block_count() const override { return blocks_.size(); }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t block) const override { return blocks_[block].extent; }
  std::uint64_t prepare(std::uint64_t block) override { return blocks_[block].bytes; }
  void read(std::uint64_t block, std::span<std::byte> into) override;

  [[nodiscard]] BlockView view(std::uint64_t block) const;

 private:
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

  // Throws SampleCountMismatch where the stream ends too early, or goes on after the timeline's end.
  std::uint64_t prepare(std::uint64_t block) override;
  void read(std::uint64_t block, std::span<std::byte> into) override;
  [[nodiscard]] std::span<const std::byte> lent() const override {
    return {payload_.data(), finished_.span_bytes};
  }

 private:
  void read_samples(std::uint64_t until, bool keep);

  CaptureFormat capture_;
  Timeline timeline_;
  SampleRange needed_;
  std::uint32_t block_samples_;
  NextSamples next_samples_;
  BlockBuilder builder_;
  std::uint64_t samples_read_ = 0;
  PageBuffer payload_;  // of the block prepared last; its memory and the builder's are used in turns
  BlockExtent extent_;  // likewise
  FinishedBlock finished_;
};

}  // namespace nutik
