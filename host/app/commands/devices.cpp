#include "session/devices.hpp"

#include "app/output/report.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "session/text/number_text.hpp"

namespace nutik::app {
namespace {

using Verdicts = std::map<Precision, Verdict>;

// `single right, fixed not tested yet`
std::string arithmetics_text(const DeviceInfo& device, const Verdicts& verdicts) {
  std::string text;
  for (const Precision precision : precisions_of(device)) {
    text += (text.empty() ? "" : ", ") + to_text(precision);
    const auto known = verdicts.find(precision);
    text += known == verdicts.end()  ? " not tested yet"
            : known->second.is_right ? " right"
                                     : format(" WRONG ({})", fault_text(known->second));
  }
  return text;
}

Json arithmetics_json(const DeviceInfo& device, const Verdicts& verdicts) {
  Json json = Json::array();
  for (const Precision precision : precisions_of(device)) {
    Json arithmetic{{"precision", to_text(precision)}, {"is_right", nullptr}};
    if (const auto known = verdicts.find(precision); known != verdicts.end()) {
      const Verdict& verdict = known->second;
      arithmetic.update({{"is_right", verdict.is_right},
                         {"light_error", verdict.light_error},
                         {"allowed_light_error", verdict.allowed_error},
                         {"wrong_codes", verdict.wrong_codes},
                         {"codes", verdict.codes}});
    }
    json.push_back(std::move(arithmetic));
  }
  return json;
}

}  // namespace

int run_devices(const Options& options) {
  if (!options.operands.empty()) throw UsageError("devices takes no file");
  const std::vector<DeviceInfo> devices = list_devices();
  Json json{{"devices", Json::array()}};
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    const Verdicts verdicts = known_verdicts(i);
    if (options.json) {
      json["devices"].push_back({{"number", i},
                                 {"name", device.name},
                                 {"kind", to_text(device.kind)},
                                 {"compute_units", device.compute_units},
                                 {"memory_bytes", device.memory_bytes},
                                 {"largest_allocation_bytes", device.largest_allocation_bytes},
                                 {"has_double", device.has_double},
                                 {"platform", device.platform},
                                 {"driver_version", device.driver_version},
                                 {"opencl_version", device.opencl_version},
                                 {"arithmetics", arithmetics_json(device, verdicts)}});
      continue;
    }
    print_line(
        format("{}  {}\n   {}, {}, {} ({} at a time), {} precision\n   {}, driver {}, {}\n   self-test: {}",
               i, device.name, to_text(device.kind), counted(device.compute_units, "compute unit"),
               bytes_text(device.memory_bytes), bytes_text(device.largest_allocation_bytes),
               device.has_double ? "double and single" : "single", device.platform, device.driver_version,
               device.opencl_version, arithmetics_text(device, verdicts)));
  }
  if (options.json) print_json(json);
  return 0;
}

}  // namespace nutik::app
