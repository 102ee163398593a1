#include "session/memory_budget.hpp"

#include <unistd.h>

#include "capture/format.hpp"
#include "session/size_text.hpp"

namespace nutik {
namespace {

// Samples that are held at least: two decoded ahead, and a block's worth of one.
constexpr std::uint64_t kLeastSamples = 8;

}  // namespace

PicturesTooLarge::PicturesTooLarge(std::uint64_t bytes, std::uint64_t sample_bytes,
                                   std::uint64_t sample_count)
    : UsageError(format("{} of memory are too little for pictures of {}, of which {} are held",
                        bytes_text(bytes), bytes_text(sample_bytes), sample_count)),
      least_bytes(sample_count * sample_bytes) {}

BlocksTooLong::BlocksTooLong(std::uint64_t bytes, std::uint32_t block_samples, std::uint64_t sample_bytes,
                             std::uint64_t most)
    : UsageError(format(
          "blocks of {} samples take {} each, and about six are held: more than the {} of memory allowed",
          block_samples, bytes_text(block_samples * sample_bytes), bytes_text(bytes))),
      most_samples(most) {}

MemoryBudget MemoryBudget::of_machine() {
  return {static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
          static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) / 2};
}

void MemoryBudget::check(const CaptureFormat& capture, std::uint32_t block_samples) const {
  const std::uint64_t sample_bytes = capture.sample_bytes();
  if (kLeastSamples * sample_bytes > bytes) throw PicturesTooLarge(bytes, sample_bytes, kLeastSamples);
  if (block_samples > 1 && block_samples * sample_bytes > block_bytes()) {
    throw BlocksTooLong(bytes, block_samples, sample_bytes,
                        std::max<std::uint64_t>(1, block_bytes() / sample_bytes));
  }
}

}  // namespace nutik
