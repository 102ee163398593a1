#include "session/preloading.hpp"

#include <algorithm>
#include <chrono>

namespace nutik {
namespace {

// None of this memory is used twice.
constexpr std::uint64_t kMaxPreloadedBytes = 256 << 20;

}  // namespace

void preload_until(const std::future<void>& ready, CaptureSource& source, const RenderPlan& plan,
                   std::uint64_t max_bytes) {
  std::uint64_t left = std::min(max_bytes, kMaxPreloadedBytes);
  for (const PlannedBlock& planned : plan.blocks) {
    const std::uint64_t bytes = source.lent_bytes(planned.block);
    const bool is_read_whole = std::ranges::none_of(plan.functions, [&](const PlannedFunction& function) {
      return function.table->span_in(planned.extent).empty();
    });
    if (bytes > left || (bytes > 0 && !is_read_whole)) return;
    source.preload(planned.block);
    left -= bytes;
    if (ready.wait_for(std::chrono::seconds(0)) == std::future_status::ready) return;
  }
}

}  // namespace nutik
