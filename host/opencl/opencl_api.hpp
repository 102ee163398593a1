// The OpenCL C++ bindings, included the same way everywhere in this room and nowhere else, with what the room says
// through them: errors as sentences, devices, the arguments of kernels, work-items, times.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wignored-attributes"
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#include <CL/opencl.hpp>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "opencl/device.hpp"
#include "opencl/kernel_layout.hpp"
#include "opencl/work_shape.hpp"

namespace nutik {

// An OpenCL error as a sentence: what was being done, the call and its code by name.
std::string describe(const cl::Error& error, const std::string& doing);

// The same with the way out, for what may happen to any device.
DeviceError device_failed(const cl::Error& error, const std::string& doing);

// All devices in the order of list_devices().
std::vector<cl::Device> all_devices();
DeviceInfo describe_device(const cl::Device& device);

// kernels/expose.cl. OpenCL C 1.2 has no structures of buffers, so that only the numbers are one.
using ExposeKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer,
                                       cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer,
                                       cl::Buffer, cl::Buffer, ExposeLaunch>;

// kernels/combine.cl.
using CombineKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer,
                                        cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, ExposeLaunch>;

// The work-items for so many tiles, in whole work-groups, which are smaller where a kernel needs more of the device.
template <typename Functor>
[[nodiscard]] cl::EnqueueArgs items(Functor& kernel, cl::CommandQueue& queue, const WorkShape& shape,
                                    std::uint64_t tile_count) {
  const std::size_t most = kernel.getKernel().template getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(
      queue.getInfo<CL_QUEUE_DEVICE>());
  const std::uint64_t group = std::min<std::uint64_t>(shape.group_items, most);
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
