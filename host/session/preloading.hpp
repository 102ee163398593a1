// Unpacks a plan's first blocks, or checks those that are not packed, while the device that will read them starts.
#pragma once

#include <cstdint>
#include <future>

#include "imev/capture_source.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// One block after another until the device is ready. It ends at the first packed block that some function does not
// read, or with which they would take more than `max_bytes`. Throws InputError for a damaged block.
void preload_until(const std::future<void>& ready, CaptureSource& source, const RenderPlan& plan,
                   std::uint64_t max_bytes);

}  // namespace nutik
