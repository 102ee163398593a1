#include "session/memory_budget.hpp"

#include "capture/format.hpp"
#include "render/picture_memory.hpp"
#include "session/text/number_text.hpp"

namespace nutik {

MemoryBudget MemoryBudget::of_machine() { return {machine_memory() / 2}; }

MemoryNeeds mask_needs(const CaptureFormat& capture) { return {{"masks", 4 * capture.shape.pixel_count()}}; }

MemoryNeeds rendering_needs(const CaptureFormat& capture, ValueType type, std::uint64_t function_count,
                            std::uint64_t block_samples) {
  MemoryNeeds needs = mask_needs(capture);
  needs.add(picture_needs(capture.shape, type));
  needs.add("gain tables of a block",
            function_count * (block_samples + 1) * (4 * kMaxSumBytes + 2 * sizeof(double)));
  return needs;
}

}  // namespace nutik
