#include "imev/capture_source.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "imev/payload_parts.hpp"
#include "system/interruption.hpp"

namespace nutik {

MemoryCapture::MemoryCapture(const CaptureFormat& source, Timeline timeline,
                             std::span<const std::vector<std::byte>> rasters, std::uint32_t block_samples,
                             TilePolicy policy)
    : capture_(held_format(source)), timeline_(std::move(timeline)) {
  if (rasters.size() != timeline_.sample_count()) {
    throw std::logic_error("a capture has another number of samples than its timeline");
  }
  BlockBuilder builder(source, block_samples, policy);
  PageBuffer spread;
  const auto close = [&] {
    const BlockExtent extent = builder.extent();
    const FinishedBlock finished = builder.finish(spread);
    const PayloadParts parts(BlockGeometry(capture_, extent.sample_count), spread.first(finished.span_bytes));
    Block block{extent, PageBuffer(parts.bytes()), parts.bytes()};
    parts.copy_to(block.payload.first(parts.bytes()));
    blocks_.push_back(std::move(block));
  };
  for (const std::vector<std::byte>& raster : rasters) {
    builder.add(raster);
    if (builder.is_full()) close();
  }
  if (!builder.is_empty()) close();
}

void MemoryCapture::read(std::uint64_t block, std::span<std::byte> into) {
  std::memcpy(into.data(), blocks_[block].payload.data(), blocks_[block].bytes);
}

BlockView MemoryCapture::view(std::uint64_t block) const {
  const Block& at = blocks_[block];
  return {capture_, at.extent, {at.payload.data(), at.bytes}};
}

SampleCountMismatch::SampleCountMismatch(std::uint64_t found, std::uint64_t expected)
    : InputError(nutik::format("the capture has {} samples where {} were expected", found, expected)),
      sample_count(found) {}

SampleRange streamed_samples(const CaptureFormat& source, SampleRange needed, std::uint32_t block_samples,
                             std::uint64_t sample_count) {
  if (source.noise.camera && !needed.empty()) {
    const std::uint64_t blocks = (needed.last + block_samples - 1) / block_samples;
    needed.last = std::min(blocks * block_samples, sample_count);
  }
  return needed;
}

StreamingCapture::StreamingCapture(const CaptureFormat& source, Timeline timeline, SampleRange needed,
                                   std::uint32_t block_samples, TilePolicy policy, NextSamples next_samples)
    : capture_(held_format(source)),
      timeline_(std::move(timeline)),
      needed_(streamed_samples(source, needed, block_samples, timeline_.sample_count())),
      block_samples_(block_samples),
      next_samples_(std::move(next_samples)),
      builder_(source, block_samples, policy) {}

std::uint64_t StreamingCapture::block_count() const {
  return (needed_.last + block_samples_ - 1) / block_samples_;
}

BlockExtent StreamingCapture::block_extent(std::uint64_t block) const {
  const std::uint64_t first = block * block_samples_;
  const std::uint64_t count = std::min<std::uint64_t>(block_samples_, needed_.last - first);
  return {first, static_cast<std::uint32_t>(count)};
}

void StreamingCapture::read_samples(std::uint64_t until, bool keep) {
  while (samples_read_ < until) {
    check_interruption();
    const auto rasters =
        next_samples_(std::min<std::uint64_t>(until - samples_read_, BlockBuilder::kSamplesAtOnce));
    if (rasters.empty()) throw SampleCountMismatch(samples_read_, timeline_.sample_count());
    samples_read_ += rasters.size();
    if (keep) {
      builder_.add(rasters);
    } else {
      for (const std::span<const std::byte> raster : rasters) builder_.pass(raster);
    }
  }
}

std::uint64_t StreamingCapture::prepare(std::uint64_t block) {
  extent_ = block_extent(block);
  if (samples_read_ > extent_.first_sample) {
    throw std::logic_error("blocks of a stream must be asked for in increasing order");
  }
  read_samples(extent_.first_sample, false);
  read_samples(extent_.range().last, true);
  finished_ = builder_.finish(payload_);
  if (samples_read_ == timeline_.sample_count()) {
    std::uint64_t more = 0;
    for (; !next_samples_(1).empty(); ++more) check_interruption();
    if (more > 0) throw SampleCountMismatch(samples_read_ + more, timeline_.sample_count());
  }
  return finished_.payload_bytes;
}

void StreamingCapture::read(std::uint64_t /*block*/, std::span<std::byte> into) {
  PayloadParts(BlockGeometry(capture_, extent_.sample_count), lent()).copy_to(into);
}

}  // namespace nutik
