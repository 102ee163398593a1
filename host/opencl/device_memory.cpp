#include "opencl/device_memory.hpp"

#include "opencl/allocation_cuts.hpp"

namespace nutik {

cl::Buffer DeviceMemory::allocate(std::uint64_t bytes, cl_mem_flags flags) {
  if (bytes > device_.largest_allocation_bytes) {
    throw too_large(device_, bytes, "a buffer", "use a device with more memory, or --renderer reference");
  }
  count(bytes);
  return {context_, flags, bytes};
}

cl::Buffer DeviceMemory::upload_bytes(std::span<const std::byte> bytes) {
  cl::Buffer buffer = allocate(std::max<std::uint64_t>(bytes.size(), 1), CL_MEM_READ_ONLY);
  if (!bytes.empty()) queue_.enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes.size(), bytes.data());
  return buffer;
}

}  // namespace nutik
