#include "session/clips/clip_memory.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "session/text/number_text.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

// Two are decoded ahead at least, so that decoding goes on while one is looked at.
constexpr std::uint64_t kMinRasters = 2;
constexpr std::uint64_t kMaxReadAhead = 64 << 20;
// What a thread that packs takes: a group of tiles (tik/codec.cpp) plain, in parts, and packed, and the codec's own.
constexpr std::uint64_t kPackingBytes = 8 << 20;

// The memory of blocks while a clip is encoded, in units of the size at which a block closes. The block being built and
// the one being packed may each reach twice that size (imev/tile_log.hpp); the packed one is no larger than its
// content. With a camera's noise there are also the samples as they came, and three times what is held of them.
std::uint64_t block_units(const CaptureFormat& capture) {
  if (!capture.noise.camera) return 5;
  return 1 + 3 * held_format(capture).sample_bytes() / capture.sample_bytes();
}

// If little changes from sample to sample, a block has room for four rasters: its first sample, changes as large as
// two, and the sample that is one too many (default_block_limits()). With less, each sample would be written whole.
constexpr std::uint64_t kMinRastersOfChanges = 4;

// Blocks of one sample, in each of the places where there is one.
std::uint64_t min_block_bytes(const ClipToRead& clip) {
  const std::uint64_t sample_bytes = clip.capture.sample_bytes();
  if (clip.tells_changes && !clip.block_samples) {
    return kMinRastersOfChanges * block_units(clip.capture) * sample_bytes;
  }
  return (clip.capture.noise.camera ? block_units(clip.capture) : 3) * sample_bytes;
}

void check_stated(const MemoryBudget& budget, const ClipToRead& clip, std::uint64_t closing_bytes) {
  const std::uint64_t sample_bytes = clip.capture.sample_bytes();
  if (!clip.block_samples || *clip.block_samples <= 1) return;
  if (*clip.block_samples * sample_bytes <= closing_bytes) return;
  throw UsageError(
      format("blocks of {} samples take {} each, and several are held: more than the {} of memory allowed",
             *clip.block_samples, bytes_text(*clip.block_samples * sample_bytes), bytes_text(budget.bytes)),
      Advice{format(" (`memory`); use fewer samples a block (`block-samples {}`)",
                    std::max<std::uint64_t>(1, closing_bytes / sample_bytes))});
}

std::uint32_t announced(const ClipToRead& clip, std::uint32_t samples) {
  if (clip.announced_samples == 0) return samples;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(samples, clip.announced_samples));
}

// With a camera's noise a block takes memory for the samples that it may hold: no more than there are.
void set_blocks(ClipMemory& memory, const ClipToRead& clip, std::uint64_t closing_bytes) {
  memory.stream_samples = announced(clip, clip.block_samples.value_or(default_block_samples(
                                              clip.capture, std::min(kDefaultBlockBytes, closing_bytes))));
  memory.blocks = clip.block_samples ? BlockLimits(*clip.block_samples)
                                     : default_block_limits(clip.capture, closing_bytes);
  // Samples in which little changes: blocks end by that alone.
  if (clip.tells_changes && !clip.block_samples && memory.blocks.changed_bytes != BlockLimits::kAnyChanges) {
    memory.blocks.samples = kLargestBlockSamples;
  }
  memory.blocks.samples = announced(clip, memory.blocks.samples);
  if (!clip.block_samples && !clip.capture.noise.camera) memory.blocks.memory_bytes = closing_bytes;
}

std::uint64_t read_ahead(std::uint64_t least, std::uint64_t rest) {
  return least + std::min(kMaxReadAhead - std::min(kMaxReadAhead, least), rest / 8);
}

}  // namespace

ClipMemory memory_for_encoding(const MemoryBudget& budget, const ClipToRead& clip,
                               const MemoryNeeds& rendering) {
  const std::uint64_t sample_bytes = clip.capture.sample_bytes();
  const std::uint64_t min_ahead = kMinRasters * sample_bytes;
  const std::uint64_t min_blocks = min_block_bytes(clip);
  const MemoryNeeds needs{{"pictures within the decoder", clip.decoder_bytes},
                          {"pictures decoded ahead", min_ahead},
                          {"blocks", min_blocks},
                          {"packing them", kPackingBytes}};
  MemoryNeeds rendering_needs = rendering;
  if (!rendering.parts().empty()) {
    rendering_needs.add("blocks", (clip.tells_changes && !clip.block_samples ? kMinRastersOfChanges : 1) *
                                      held_format(clip.capture).sample_bytes());
  }
  if (rendering_needs.bytes() > needs.bytes()) rendering_needs.rest_of(budget.bytes);
  std::uint64_t rest = needs.rest_of(budget.bytes);

  ClipMemory memory;
  memory.read_ahead_bytes = read_ahead(min_ahead, rest);
  rest -= memory.read_ahead_bytes - min_ahead;
  const std::uint64_t more_threads = std::min<std::uint64_t>(core_count() - 1, rest / 8 / kPackingBytes);
  memory.threads = static_cast<std::uint32_t>(1 + more_threads);
  rest -= more_threads * kPackingBytes;
  std::uint64_t closing = (rest + min_blocks) / block_units(clip.capture);
  if (!clip.capture.noise.camera && !clip.tells_changes) {
    closing = std::max(sample_bytes, rest / block_units(clip.capture));
  }
  if (!rendering.parts().empty()) closing = std::min(closing, budget.bytes - rendering.bytes());
  check_stated(budget, clip, closing);
  set_blocks(memory, clip, closing);
  return memory;
}

ClipMemory memory_for_streaming(const MemoryBudget& budget, const ClipToRead& clip,
                                const MemoryNeeds& rendering) {
  const std::uint64_t sample_bytes = clip.capture.sample_bytes();
  const std::uint64_t min_ahead = kMinRasters * sample_bytes;
  const std::uint64_t min_blocks = min_block_bytes(clip);
  MemoryNeeds needs{{"pictures within the decoder", clip.decoder_bytes},
                    {"pictures decoded ahead", min_ahead},
                    {"blocks", min_blocks}};
  needs.add(rendering);
  std::uint64_t rest = needs.rest_of(budget.bytes);

  ClipMemory memory;
  memory.read_ahead_bytes = read_ahead(min_ahead, rest);
  rest -= memory.read_ahead_bytes - min_ahead;
  // Half of the rest: tables and maps share the other one.
  const std::uint64_t closing = (rest / 2 + min_blocks) / block_units(clip.capture);
  check_stated(budget, clip, closing);
  set_blocks(memory, clip, closing);
  memory.bytes = clip.decoder_bytes + memory.read_ahead_bytes + min_blocks + rest / 2;
  return memory;
}

}  // namespace nutik
