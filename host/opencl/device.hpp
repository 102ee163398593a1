// The OpenCL devices of this machine, and the choice of one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nutik {

enum class DeviceKind { gpu, accelerator, cpu, other };
std::string to_text(DeviceKind kind);

struct DeviceInfo {
  std::string name;
  std::string platform;
  std::string driver_version;
  std::string opencl_version;
  DeviceKind kind = DeviceKind::other;
  std::uint32_t compute_units = 0;
  std::uint64_t memory_bytes = 0;
  std::uint64_t largest_allocation_bytes = 0;
  std::uint32_t native_float_lanes = 0;  // of its vector registers; 1 where work-items are lanes themselves
  // Iterations after which a work-item's loops end, all of them together, whether they are done or not; 0: never.
  std::uint32_t loop_limit = 0;
  bool has_double = false;
  std::uint64_t group_memory_bytes = 0;  // beside the work-items of a group; 0: such memory is like any other
  bool shares_host_memory = false;
  bool permutes_bytes = false;  // kernels may use vpermi2b, which looks 64 bytes up in a table of 128, and gain by it
};

// For an application, before it has a second thread: sets variables of the environment, but for PATH where they are not
// set.
//
//   PATH                               has /usr/bin at its end: PoCL ends the process where it finds no linker
//   POCL_WORK_GROUP_SPECIALIZATION=0   PoCL builds each kernel once, for groups of any size. It would build it for the
//                                      size at hand, and again for the binary that is kept; neither runs faster
//   HWLOC_PLUGINS_PATH=/dev/null       PoCL sets this itself, on the thread that looks for devices. Where the variable
//                                      is new, the environment moves, while other threads may be reading it
//   POCL_CACHE_DIR                     only where PoCL's usual folder is not safe (opencl/cache_folder.hpp)
void prepare_for_pocl();

// Every device of every platform, the ones to prefer first: GPUs, accelerators, CPUs, and of a kind those without a
// loop_limit; the position is the index that OpenClOptions::device takes. Throws DeviceError where there is no OpenCL
// platform at all.
[[nodiscard]] std::vector<DeviceInfo> list_devices();

// The index of the device that a person means: a number, or part of a name or platform in any case; empty
// means the first. Throws DeviceError listing the devices where none or several match.
[[nodiscard]] std::size_t choose_device(std::span<const DeviceInfo> devices, std::string_view wanted);

// The same of one or several: `0,2`, `radeon,nvidia`, or `all`. In the order in which they are named. Throws
// DeviceError besides where one is named twice.
[[nodiscard]] std::vector<std::size_t> choose_devices(std::span<const DeviceInfo> devices, std::string_view wanted);
// Whether what a person says may mean several.
[[nodiscard]] bool may_mean_several(std::string_view wanted);

}  // namespace nutik
