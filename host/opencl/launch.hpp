// What the launches of all kernels share.
#pragma once

#include "opencl/opencl_api.hpp"
#include "opencl/work_shape.hpp"

namespace nutik {

// The work-items for so many tiles, in whole work-groups.
[[nodiscard]] inline cl::EnqueueArgs items(cl::CommandQueue& queue, const WorkShape& shape,
                                           std::uint64_t tile_count) {
  const std::uint64_t group = shape.group_items;
  const std::uint64_t count = shape.items(tile_count);
  return {queue, cl::NDRange((count + group - 1) / group * group), cl::NDRange(group)};
}

// What a command took by the device's own clock.
[[nodiscard]] inline double milliseconds(const cl::Event& event) {
  return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                             event.getProfilingInfo<CL_PROFILING_COMMAND_START>()) *
         1e-6;
}

}  // namespace nutik
