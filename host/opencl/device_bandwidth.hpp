// How fast a device copies its own memory: the limit for what kernels read from it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace nutik {

// Bytes a second read and written by the device's own copy of a buffer of about `bytes`: the best of
// several. Throws DeviceError.
[[nodiscard]] double device_copy_bandwidth(std::size_t device, std::uint64_t bytes);

}  // namespace nutik
