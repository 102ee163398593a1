#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "app/text/size_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/device.hpp"

namespace nutik::app {

int run_devices(const Options& options) {
  if (!options.operands.empty()) throw UsageError("devices takes no file");
  const std::vector<DeviceInfo> devices = list_devices();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    print_line(format(
        "{}  {}\n   {}, {} compute units, {} ({} at a time), {} precision\n   {}, driver {}, {}", i,
        device.name, to_text(device.kind), device.compute_units, bytes_text(device.memory_bytes),
        bytes_text(device.largest_allocation_bytes), device.has_double ? "double and single" : "single",
        device.platform, device.driver_version, device.opencl_version));
  }
  return 0;
}

}  // namespace nutik::app
