#include "imev/capture_source.hpp"

#include <algorithm>
#include <mutex>
#include <stdexcept>

#include "capture/format.hpp"
#include "imev/block_lease.hpp"
#include "imev/expected_values.hpp"
#include "system/interruption.hpp"
#include "system/parallel.hpp"

namespace nutik {

MemoryCapture::MemoryCapture(const CaptureFormat& source, Timeline timeline,
                             std::span<const std::vector<std::byte>> rasters, const BlockLimits& limits,
                             TilePolicy policy)
    : capture_(held_format(source)), timeline_(std::move(timeline)) {
  if (rasters.size() != timeline_.sample_count()) {
    throw std::logic_error("a capture has another number of samples than its timeline");
  }
  BlockBuilder builder(source, limits, policy);
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

BlockLease MemoryCapture::lend(std::uint64_t block, const LeaseTerms& /*terms*/) {
  const Block& at = blocks_[block];
  return {at.extent, {at.payload.data(), at.bytes}};
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

class StreamingCapture::SparePayloads {
 public:
  void put(PageBuffer payload) {
    const std::scoped_lock lock(mutex_);
    payloads_.push_back(std::move(payload));
  }
  // Empty where none is spare.
  PageBuffer take() {
    const std::scoped_lock lock(mutex_);
    if (payloads_.empty()) return {};
    PageBuffer payload = std::move(payloads_.back());
    payloads_.pop_back();
    return payload;
  }

 private:
  std::mutex mutex_;
  std::vector<PageBuffer> payloads_;
};

StreamingCapture::StreamingCapture(const CaptureFormat& source, Timeline timeline, SampleRange needed,
                                   std::uint32_t block_samples, TilePolicy policy, NextSamples next_samples)
    : capture_(held_format(source)),
      timeline_(std::move(timeline)),
      needed_(streamed_samples(source, needed, block_samples, timeline_.sample_count())),
      block_samples_(block_samples),
      next_samples_(std::move(next_samples)),
      builder_(source, block_samples, policy, half_the_cores()),
      spares_(std::make_shared<SparePayloads>()) {}

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

BlockLease StreamingCapture::lend(std::uint64_t block, const LeaseTerms& /*terms*/) {
  const BlockExtent extent = block_extent(block);
  if (samples_read_ > extent.first_sample) {
    throw std::logic_error("blocks of a stream must be asked for in increasing order");
  }
  read_samples(extent.first_sample, false);
  builder_.build_in(spares_->take());
  read_samples(extent.range().last, true);
  const auto payload = std::shared_ptr<PageBuffer>(new PageBuffer, [spares = spares_](PageBuffer* built) {
    spares->put(std::move(*built));
    delete built;
  });
  const FinishedBlock finished = builder_.finish(*payload);
  if (samples_read_ == timeline_.sample_count()) {
    std::uint64_t more = 0;
    for (; !next_samples_(1).empty(); ++more) check_interruption();
    if (more > 0) throw SampleCountMismatch(samples_read_ + more, timeline_.sample_count());
  }
  return BlockLease::spread(extent, payload->first(finished.span_bytes), finished.payload_bytes, payload);
}

}  // namespace nutik
