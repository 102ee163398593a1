#include "session/devices.hpp"
#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "app/output/json.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/size_text.hpp"

namespace nutik::app {

int run_devices(const Options& options) {
  if (!options.operands.empty()) throw UsageError("devices takes no file");
  const std::vector<DeviceInfo> devices = list_devices();
  if (options.json) {
    Json json{{"devices", Json::array()}};
    for (std::size_t i = 0; i < devices.size(); ++i) {
      const DeviceInfo& device = devices[i];
      json["devices"].push_back({{"number", i},
                                 {"name", device.name},
                                 {"kind", to_text(device.kind)},
                                 {"compute_units", device.compute_units},
                                 {"memory_bytes", device.memory_bytes},
                                 {"largest_allocation_bytes", device.largest_allocation_bytes},
                                 {"has_double", device.has_double},
                                 {"platform", device.platform},
                                 {"driver_version", device.driver_version},
                                 {"opencl_version", device.opencl_version}});
    }
    print_json(json);
    return 0;
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    print_line(format("{}  {}\n   {}, {}, {} ({} at a time), {} precision\n   {}, driver {}, {}", i,
                      device.name, to_text(device.kind), counted(device.compute_units, "compute unit"),
                      bytes_text(device.memory_bytes), bytes_text(device.largest_allocation_bytes),
                      device.has_double ? "double and single" : "single", device.platform,
                      device.driver_version, device.opencl_version));
  }
  return 0;
}

}  // namespace nutik::app
