#include "opencl/device_bandwidth.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "opencl/opencl_api.hpp"

namespace nutik {

double device_copy_bandwidth(std::size_t device, std::uint64_t bytes) {
  try {
    const cl::Device chosen = all_devices().at(device);
    bytes = std::min(bytes, describe_device(chosen).largest_allocation_bytes);
    const cl::Context context(chosen);
    const cl::CommandQueue queue(context, chosen, CL_QUEUE_PROFILING_ENABLE);
    const cl::Buffer from(context, CL_MEM_READ_WRITE, bytes);
    const cl::Buffer to(context, CL_MEM_READ_WRITE, bytes);
    queue.enqueueFillBuffer(from, cl_uint{0x5A17C3E9}, 0, bytes / 4 * 4);
    double best = 0.0;
    for (int run = 0; run < 7; ++run) {
      cl::Event event;
      queue.enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, &event);
      event.wait();
      const std::optional<double> took_ms = milliseconds(event);
      if (!took_ms) throw DeviceError("this driver does not time copies: their rate cannot be measured");
      best = std::max(best, 2.0 * static_cast<double>(bytes) / *took_ms * 1e3);
    }
    return best;
  } catch (const cl::Error& error) {
    throw DeviceError(describe(error, "the device's copy rate cannot be measured"));
  }
}

}  // namespace nutik
