#include "opencl/device_memory.hpp"

#include "opencl/allocation_cuts.hpp"

namespace nutik {

cl::Buffer DeviceMemory::allocate(std::uint64_t bytes, cl_mem_flags flags, const void* from) {
  if (bytes > device_.largest_allocation_bytes) {
    throw too_large(device_, bytes, "a buffer", "use a device with more memory, or the reference",
                    {Setting::renderer});
  }
  count(bytes);
  return {context_, flags, bytes, const_cast<void*>(from)};  // which is only read
}

cl::Buffer DeviceMemory::upload_bytes(std::span<const std::byte> bytes) {
  if (bytes.empty()) return allocate(1, CL_MEM_READ_ONLY);
  // Copied as it is made: a command of the queue would have to be waited for.
  return allocate(bytes.size(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, bytes.data());
}

}  // namespace nutik
