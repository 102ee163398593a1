// What kernels look up beside gain tables, on the device from one exposure to the next: light of codes, codes of light,
// each pixel's function.
//
//   always:  made again only for another capture's codes, another picture's format, another mask or rectangle
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "opencl/allocation_cuts.hpp"
#include "opencl/device_memory.hpp"
#include "opencl/function_map.hpp"
#include "opencl/kernel_numbers.hpp"
#include "opencl/light_source.hpp"
#include "opencl/opencl_api.hpp"
#include "opencl/recent.hpp"
#include "render/mask_map.hpp"

namespace nutik {

// Light of a capture's codes.
struct LightKey {
  Transfer transfer = Transfer::linear();
  std::uint32_t code_bytes = 1;
  std::uint32_t white_code = 255;
  Precision precision = Precision::single_;
  std::uint64_t fixed_white_light = 0;
  friend bool operator==(const LightKey&, const LightKey&) = default;
};
struct DeviceLight {
  LightKey key;
  const char* kind = nullptr;  // LightSource::kind
  bool has_byte_tables = false;
  cl::Buffer values;
  std::uint64_t value_bytes = 0;
  [[nodiscard]] std::uint64_t bytes() const { return value_bytes; }
};

// Codes of a picture's light.
struct DeviceCodes {
  CodeKey key;
  cl::Buffer thresholds;
  cl::Buffer guesses;
  cl_uint guess_count = 0;
  std::uint64_t table_bytes = 0;
  [[nodiscard]] std::uint64_t bytes() const { return table_bytes; }
};

// A band's functions (function_map.hpp).
struct DeviceMap {
  std::shared_ptr<const MaskMap> map;
  Band band;
  cl::Buffer tiles;
  cl::Buffer of_lane;
  cl::Buffer of_tile;
  cl::Buffer first_of, shares;              // where tiles are mixed, else none
  std::shared_ptr<const FunctionMap> host;  // without of_lane where no tile is mixed
  std::uint64_t device_bytes = 0;
  [[nodiscard]] std::uint64_t bytes() const { return device_bytes; }
};

class DeviceLookups {
 public:
  // Maps of `max_map_bytes` are kept.
  explicit DeviceLookups(std::uint64_t max_map_bytes) : maps_(max_map_bytes) {}

  // `means` as for light_source(). What is returned counts in `memory`; it stays until the next of its kind
  // is asked for.
  const DeviceLight& light(const RenderPlan& plan, Precision precision, const LightLookup& means, DeviceMemory& memory);
  // Null where the codes lie too close together (code_search() in kernel_numbers.cpp).
  const DeviceCodes* codes(const CodeKey& key, DeviceMemory& memory);
  // Adds to `written_bytes` what had to be written.
  const DeviceMap& map(const std::shared_ptr<const MaskMap>& map, const Band& band, DeviceMemory& memory,
                       std::uint64_t& written_bytes);

 private:
  static constexpr std::uint64_t kTableBytes = 32u << 20;  // of light, and of codes

  Recent<DeviceLight> light_{kTableBytes};
  Recent<DeviceCodes> codes_{kTableBytes};
  Recent<DeviceMap> maps_;
};

}  // namespace nutik
