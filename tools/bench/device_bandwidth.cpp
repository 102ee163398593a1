#include "device_bandwidth.hpp"

#include <algorithm>
#include <chrono>

#include "capture/error.hpp"
#include "opencl/opencl_api.hpp"
#include "system/page_buffer.hpp"

namespace nutik::bench {
namespace {

constexpr int kCopies = 5;

// Bytes a second of the fastest of several runs, by the host's clock.
template <typename Copy>
double best_rate(std::uint64_t bytes, Copy copy) {
  double best = 0.0;
  for (int run = 0; run < kCopies; ++run) {
    const auto start = std::chrono::steady_clock::now();
    copy();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best = std::max(best, static_cast<double>(bytes) / took.count());
  }
  return best;
}

}  // namespace

TransferRates transfer_rates(std::size_t device, std::uint64_t bytes) {
  try {
    const cl::Device chosen = all_devices().at(device);
    const cl::Context context(chosen);
    const cl::CommandQueue queue(context, chosen);
    const cl::Buffer on_device(context, CL_MEM_READ_WRITE, bytes);
    const cl::Buffer pinned(context, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes);
    void* const in_pinned = queue.enqueueMapBuffer(pinned, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes);
    PageBuffer pageable(bytes);
    std::fill_n(pageable.data(), bytes, std::byte{1});
    std::fill_n(static_cast<std::byte*>(in_pinned), bytes, std::byte{2});
    const auto write = [&](const void* from) {
      return best_rate(bytes, [&] { queue.enqueueWriteBuffer(on_device, CL_TRUE, 0, bytes, from); });
    };
    const auto read = [&](void* to) {
      return best_rate(bytes, [&] { queue.enqueueReadBuffer(on_device, CL_TRUE, 0, bytes, to); });
    };
    const TransferRates rates{write(pageable.data()), write(in_pinned), read(pageable.data()), read(in_pinned)};
    queue.enqueueUnmapMemObject(pinned, in_pinned);
    queue.finish();
    return rates;
  } catch (const cl::Error& error) {
    throw DeviceError(describe(error, "the rate of copies to the device cannot be measured"));
  }
}

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
    for (int run = 0; run < kCopies; ++run) {
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

}  // namespace nutik::bench
