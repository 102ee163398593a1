// The buffers of one exposure: none larger than the device allocates at a time, all of them counted.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "opencl/device.hpp"
#include "opencl/opencl_api.hpp"

namespace nutik {

class DeviceMemory {
 public:
  DeviceMemory(cl::Context context, const DeviceInfo& device)
      : context_(std::move(context)), device_(device) {}

  // Throws DeviceError where the device allocates less at a time.
  [[nodiscard]] cl::Buffer allocate(std::uint64_t bytes, cl_mem_flags flags, const void* from = nullptr);

  // A read-only buffer with these values. Never of no bytes: OpenCL has no such thing.
  template <typename Values>
  [[nodiscard]] cl::Buffer upload(const Values& values) {
    return upload_bytes(std::as_bytes(std::span(values)));
  }

  // Counts what others allocated.
  void count(std::uint64_t bytes) {
    held_bytes_ += bytes;
    max_bytes_ = std::max(max_bytes_, held_bytes_);
  }

  // The largest sum at a time.
  [[nodiscard]] std::uint64_t max_bytes() const { return max_bytes_; }

  // What is made in a scope no longer counts when it ends.
  class Scope {
   public:
    explicit Scope(DeviceMemory& memory) : memory_(memory), before_(memory.held_bytes_) {}
    ~Scope() { memory_.held_bytes_ = before_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    DeviceMemory& memory_;
    std::uint64_t before_;
  };

 private:
  cl::Buffer upload_bytes(std::span<const std::byte> bytes);

  cl::Context context_;
  const DeviceInfo& device_;
  std::uint64_t held_bytes_ = 0;
  std::uint64_t max_bytes_ = 0;
};

}  // namespace nutik
