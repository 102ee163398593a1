#include "opencl/kernel_constants.hpp"

#include <algorithm>
#include <utility>

#include "capture/format.hpp"
#include "opencl/light_source.hpp"
#include "render/fixed_scale.hpp"

namespace nutik {
namespace {

const char* kernel_name_of(Precision precision) {
  switch (precision) {
    case Precision::single_: return "NUTIK_SINGLE";
    case Precision::compensated: return "NUTIK_COMPENSATED";
    case Precision::double_: return "NUTIK_DOUBLE";
    case Precision::fixed: return "NUTIK_FIXED";
  }
  return "";
}

// -w: drivers print how many warnings they counted, in their own headers too. tools/check_kernels looks at ours.
std::string common_options(const Work& work, const CaptureFormat& capture, bool has_delays) {
  return format(
      "-w -cl-std=CL1.2 -DNUTIK_PRECISION={} -DNUTIK_HAS_FMA={} -DNUTIK_CHANNELS={} -DNUTIK_FUNCTION_BYTES={}",
      kernel_name_of(work.precision), work.has_fma ? 1 : 0, capture.shape.channels, has_delays ? 2 : 1);
}

}  // namespace

std::string expose_options(const Work& work, const CaptureFormat& capture, const char* light_kind,
                           bool has_delays, bool has_byte_tables) {
  const bool has_copies = capture.code_bytes == 1 && light_kind == std::string_view("NUTIK_LIGHT_TABLE");
  return format(
      "{} -DNUTIK_CODE_BYTES={} -DNUTIK_LIGHT={} -DNUTIK_ITEM_PIXELS={} -DNUTIK_ITEM_TILES={} "
      "-DNUTIK_LANES={} -DNUTIK_ROWS_AT_ONCE={} -DNUTIK_TABLE_COPIES={} -DNUTIK_BYTE_TABLES={}",
      common_options(work, capture, has_delays), capture.code_bytes, light_kind, work.shape.item_pixels,
      work.shape.item_tiles, work.shape.lanes, work.shape.rows_at_once, has_copies ? work.shape.table_copies : 0,
      has_byte_tables ? 1 : 0);
}

std::string develop_options(const Work& work, const CaptureFormat& capture, const OutputFormat& output,
                            bool blends, bool has_delays) {
  const std::size_t raster_bytes = holds_codes(output.type) ? value_bytes(output.type) : 1;
  return format(
      "{} -DNUTIK_ITEM_PIXELS={} -DNUTIK_ITEM_TILES={} -DNUTIK_LANES={} "
      "-DNUTIK_TABLE_COPIES=0 -DNUTIK_RASTER_BYTES={} -DNUTIK_BLENDS={}",
      common_options(work, capture, has_delays), work.shape.item_pixels, work.shape.item_tiles,
      std::min(work.shape.lanes, kTileSide), raster_bytes, blends ? 1 : 0);
}

const DeviceLight& KernelConstants::light(const RenderPlan& plan, Precision precision, const LightLookup& means,
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

const DeviceCodes* KernelConstants::codes(const CodeKey& key, DeviceMemory& memory) {
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

const DeviceMap& KernelConstants::map(const std::shared_ptr<const MaskMap>& map, const Band& band,
                                      DeviceMemory& memory, std::uint64_t& written_bytes) {
  // No plan has the mask any more; another capture's is a map of its own, however alike.
  maps_.forget([](const DeviceMap& each) { return each.map.use_count() == 1; });
  const DeviceMap* const kept =
      maps_.find([&](const DeviceMap& each) { return each.map == map && each.band == band; });
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
