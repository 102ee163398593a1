// Unpacks a plan's first blocks while the device that will read them starts.
#pragma once

#include <cstdint>
#include <future>

#include "imev/capture_source.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// One block after another until the device is ready, of at most `max_bytes` together, as far as they are packed and
// every function reads some of them. Throws InputError for a damaged block.
void preload_until(const std::future<void>& ready, CaptureSource& source, const RenderPlan& plan,
                   std::uint64_t max_bytes);

}  // namespace nutik
