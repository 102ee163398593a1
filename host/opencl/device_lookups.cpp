#include "opencl/device_lookups.hpp"

#include <utility>

#include "opencl/light_source.hpp"
#include "render/fixed_scale.hpp"

namespace nutik {

const DeviceLight& DeviceLookups::light(const RenderPlan& plan, Precision precision, const LightLookup& means,
                                        DeviceMemory& memory) {
  const CaptureFormat& capture = plan.capture;
  LightKey key{capture.transfer, capture.code_bytes, capture.white_code, precision};
  if (precision == Precision::fixed) key.fixed_white_light = fixed_scale(plan).white_light;
  if (const DeviceLight* kept = light_.find([&](const DeviceLight& each) { return each.key == key; })) {
    memory.count(kept->bytes());
    return *kept;
  }
  const LightSource source = light_source(capture, precision, means);
  const Bytes values = light_values(source, precision, key.fixed_white_light);
  return light_.keep({key, source.kind, !source.bytewise.empty(), memory.upload(values), values.size()});
}

const DeviceCodes* DeviceLookups::codes(const CodeKey& key, DeviceMemory& memory) {
  if (const DeviceCodes* kept = codes_.find([&](const DeviceCodes& each) { return each.key == key; })) {
    memory.count(kept->bytes());
    return kept;
  }
  const std::optional<CodeTables> tables = code_tables(key);
  if (!tables) return nullptr;
  return &codes_.keep({key, memory.upload(tables->thresholds), memory.upload(tables->guesses),
                       static_cast<cl_uint>(tables->guesses.size()),
                       tables->thresholds.size() + tables->guesses.size() * sizeof(std::uint32_t)});
}

const DeviceMap& DeviceLookups::map(const std::shared_ptr<const MaskMap>& map, const Band& band, DeviceMemory& memory,
                                    std::uint64_t& written_bytes) {
  // No plan has the mask any more; another capture's is a map of its own, however alike.
  maps_.forget([](const DeviceMap& each) { return each.map.use_count() == 1; });
  const DeviceMap* const kept = maps_.find([&](const DeviceMap& each) { return each.map == map && each.band == band; });
  if (kept != nullptr) {
    memory.count(kept->bytes());
    return *kept;
  }
  FunctionMap functions = map_functions(*map, band);
  const auto upload_lanes = [&] {
    if (functions.lane_bytes == sizeof(std::uint16_t)) return memory.upload(functions.of_lane);
    return memory.upload(std::vector<std::uint8_t>(functions.of_lane.begin(), functions.of_lane.end()));
  };
  DeviceMap on_device{map,
                      band,
                      memory.upload(functions.tiles),
                      upload_lanes(),
                      memory.upload(functions.of_tile),
                      {},
                      {},
                      nullptr,
                      functions.bytes()};
  if (functions.is_mixed()) {
    on_device.first_of = memory.upload(functions.first_of);
    on_device.shares = memory.upload(functions.shares);
  } else {
    std::vector<std::uint16_t>().swap(functions.of_lane);  // assigning {} would keep its memory
  }
  on_device.host = std::make_shared<const FunctionMap>(std::move(functions));
  const DeviceMap& made = maps_.keep(std::move(on_device));
  written_bytes += made.bytes();
  return made;
}

}  // namespace nutik
