// What the launches of all kernels share.
#pragma once

#include <optional>

#include "opencl/opencl_api.hpp"
#include "opencl/work_shape.hpp"

namespace nutik {

// kernels/expose.cl.
using ExposeKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl_uint, cl::Buffer, cl::Buffer, cl::Buffer,
                                       cl::Buffer, cl_uint, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer,
                                       cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl_ulong, cl_uint>;

// The work-items for so many tiles, in whole work-groups.
[[nodiscard]] inline cl::EnqueueArgs items(cl::CommandQueue& queue, const WorkShape& shape,
                                           std::uint64_t tile_count) {
  const std::uint64_t group = shape.group_items;
  const std::uint64_t count = shape.items(tile_count);
  return {queue, cl::NDRange((count + group - 1) / group * group), cl::NDRange(group)};
}

// What a command took by the device's own clock; nothing if the driver has none. (Mesa 22.3 numbers the steps of a
// command from 0 to 3 instead of timing them: no clock of nanoseconds is that young.)
[[nodiscard]] inline std::optional<double> milliseconds(const cl::Event& event) {
  constexpr cl_ulong kYoungest = 1000;
  const cl_ulong start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  if (start < kYoungest) return {};
  return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - start) * 1e-6;
}

}  // namespace nutik
