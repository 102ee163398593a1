// How fast a device copies its own memory, the limit for what kernels read from it, and to and from the host's.
#pragma once

#include <cstddef>
#include <cstdint>

namespace nutik::bench {

// Bytes a second read and written by the device's own copy of a buffer of about `bytes`: the best of
// several. Throws DeviceError.
[[nodiscard]] double device_copy_bandwidth(std::size_t device, std::uint64_t bytes);

// Bytes a second between the host's memory and the device's, the best of several copies: of memory as programs have it,
// and of memory that the driver has pinned. Throws DeviceError.
struct TransferRates {
  double upload, pinned_upload, readback, pinned_readback;
};
[[nodiscard]] TransferRates transfer_rates(std::size_t device, std::uint64_t bytes);

}  // namespace nutik::bench
