#include "opencl/device.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "opencl/cache_folder.hpp"
#include "opencl/opencl_api.hpp"
#include "system/is_absent.hpp"
#include "system/own_folders.hpp"

namespace nutik {
namespace {

DeviceKind kind_of(cl_device_type type) {
  if ((type & CL_DEVICE_TYPE_GPU) != 0) return DeviceKind::gpu;
  if ((type & CL_DEVICE_TYPE_ACCELERATOR) != 0) return DeviceKind::accelerator;
  if ((type & CL_DEVICE_TYPE_CPU) != 0) return DeviceKind::cpu;
  return DeviceKind::other;
}

// Mesa's llvmpipe, a GPU that is simulated, keeps a shader that would hang from doing so. Kernels pay for it: long
// exposures lack light, and nothing says so. (Seen with Mesa 22.3.)
std::uint32_t loop_limit_of(const DeviceInfo& info) {
  return info.platform == "rusticl" && info.name.starts_with("llvmpipe") ? 65'535 : 0;
}

// Whether kernels run on this processor, and it is an AMD: Intel's take three operations for the instruction, so that
// nothing would be gained. PoCL 6 takes an instruction that is written out for a call of its own, and ends the program;
// 3 and 7 do not, 4 and 5 have not been tried.
bool permutes_bytes(const DeviceInfo& info) {
#ifdef __x86_64__
  return info.platform == "Portable Computing Language" && info.kind == DeviceKind::cpu &&
         info.driver_version.find_first_of("456") != 0 &&
         __builtin_cpu_is("amd") && __builtin_cpu_supports("avx512vbmi");
#else
  return static_cast<void>(info), false;
#endif
}

// Some drivers pad names with blanks and end them with a zero.
constexpr std::string_view kPadding(" \0", 2);

// The devices whose name or platform contains the text, in any case.
std::vector<std::size_t> named(std::span<const DeviceInfo> devices, std::string_view wanted) {
  std::vector<std::size_t> matches;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const std::string text = in_small_letters(devices[i].name) + '\n' + in_small_letters(devices[i].platform);
    if (text.find(in_small_letters(wanted)) != std::string::npos) matches.push_back(i);
  }
  return matches;
}

bool means_all(std::string_view wanted) { return in_small_letters(trimmed(wanted)) == "all"; }

std::string list_text(std::span<const DeviceInfo> devices) {
  std::string text;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    text += format("\n  {}  {} ({}, {})", i, devices[i].name, to_text(devices[i].kind), devices[i].platform);
  }
  return text;
}

// The names of the error codes that people meet.
std::string error_name(cl_int code) {
  switch (code) {
    case CL_DEVICE_NOT_FOUND: return "CL_DEVICE_NOT_FOUND";
    case CL_DEVICE_NOT_AVAILABLE: return "CL_DEVICE_NOT_AVAILABLE";
    case CL_COMPILER_NOT_AVAILABLE: return "CL_COMPILER_NOT_AVAILABLE";
    case CL_MEM_OBJECT_ALLOCATION_FAILURE: return "CL_MEM_OBJECT_ALLOCATION_FAILURE";
    case CL_OUT_OF_RESOURCES: return "CL_OUT_OF_RESOURCES";
    case CL_OUT_OF_HOST_MEMORY: return "CL_OUT_OF_HOST_MEMORY";
    case CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST: return "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST";
    case CL_BUILD_PROGRAM_FAILURE: return "CL_BUILD_PROGRAM_FAILURE";
    case CL_INVALID_VALUE: return "CL_INVALID_VALUE";
    case CL_INVALID_BUFFER_SIZE: return "CL_INVALID_BUFFER_SIZE";
    case CL_INVALID_BINARY: return "CL_INVALID_BINARY";
    case CL_INVALID_KERNEL_NAME: return "CL_INVALID_KERNEL_NAME";
    case CL_INVALID_KERNEL_ARGS: return "CL_INVALID_KERNEL_ARGS";
    case CL_INVALID_WORK_GROUP_SIZE: return "CL_INVALID_WORK_GROUP_SIZE";
    case -1001: return "CL_PLATFORM_NOT_FOUND_KHR";
    default: return format("OpenCL error {}", code);
  }
}

// The platforms of a PoCL that lies beside the program, where it was unpacked from an archive: no loader knows of it.
// It is asked as a loader asks, and calls find their way through its objects. Never closed: its devices outlive any
// caller.
std::vector<cl::Platform> own_platforms() {
  for (const std::filesystem::path& folder : own_folders()) {
    const std::filesystem::path file = folder / "pocl" / "lib" / "opencl" / "libpocl.so";
    if (is_absent(file)) continue;
    void* const driver = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (driver == nullptr) continue;
    const auto find = reinterpret_cast<void*(CL_API_CALL*)(const char*)>(
        dlsym(driver, "clGetExtensionFunctionAddress"));
    const auto list = find == nullptr ? nullptr
                                      : reinterpret_cast<decltype(&clGetPlatformIDs)>(find("clIcdGetPlatformIDsKHR"));
    cl_platform_id platform = nullptr;
    cl_uint count = 0;
    if (list == nullptr || list(1, &platform, &count) != CL_SUCCESS || count == 0) continue;
    // Where its compiler looks for a linker first; the linker there hands on what is no kernel (tools/archive).
    const char* const others = std::getenv("COMPILER_PATH");
    const std::string path = file.parent_path().string() + (others == nullptr ? "" : std::string(":") + others);
    ::setenv("COMPILER_PATH", path.c_str(), 1);
    return {cl::Platform(platform)};
  }
  return {};
}

void add_devices(std::span<const cl::Platform> platforms, std::vector<cl::Device>& devices) {
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> found;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
    } catch (const cl::Error&) {
      continue;  // a platform without devices reports an error
    }
    devices.insert(devices.end(), found.begin(), found.end());
  }
}

}  // namespace

std::string to_text(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::gpu: return "GPU";
    case DeviceKind::accelerator: return "accelerator";
    case DeviceKind::cpu: return "CPU";
    case DeviceKind::other: return "other";
  }
  return {};
}

std::string describe(const cl::Error& error, const std::string& doing) {
  const bool may_be_cache = error.err() == CL_BUILD_PROGRAM_FAILURE || error.err() == CL_INVALID_KERNEL_NAME;
  return format("{}: {} in {}{}", doing, error_name(error.err()), error.what(),
                may_be_cache ? format("; if this is PoCL, its cache may be damaged or not writable: delete {}, or set "
                                      "POCL_CACHE_DIR to a folder of yours",
                                      cache_of_pocl().string())
                             : "");
}

DeviceError device_failed(const cl::Error& error, const std::string& doing) {
  return DeviceError(describe(error, doing), Advice{"; use another device or the reference (`renderer`)"});
}

std::vector<cl::Device> all_devices() {
  choose_cache_of_pocl();
  if (const std::string flaw = flaw_of_pocl_cache(); !flaw.empty()) {
    throw DeviceError(format("PoCL has no folder to build kernels in: {}; set POCL_CACHE_DIR to a folder of yours "
                             "alone with room",
                             flaw),
                      Advice{", or use the reference (`renderer`)"});
  }
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    platforms.clear();
  }
  std::vector<cl::Device> devices;
  add_devices(platforms, devices);
  const auto is_processor = [](const cl::Device& device) { return describe_device(device).kind == DeviceKind::cpu; };
  if (std::ranges::none_of(devices, is_processor)) {
    static const std::vector<cl::Platform> own = own_platforms();
    add_devices(own, devices);
  }
  if (devices.empty()) {
    throw DeviceError(
        "no OpenCL device was found; install a driver (on Debian: apt install pocl-opencl-icd for the "
        "processor, or the graphics card's OpenCL package). If one is installed: PoCL starts only if it may "
        "write its cache (set POCL_CACHE_DIR to such a folder)",
        Advice{". Or use the reference (`renderer`)"});
  }
  std::ranges::stable_sort(devices, {}, [](const cl::Device& device) {
    const DeviceInfo info = describe_device(device);
    return std::pair(info.kind, info.loop_limit != 0);
  });
  return devices;
}

DeviceInfo describe_device(const cl::Device& device) {
  DeviceInfo info;
  info.name = trimmed(device.getInfo<CL_DEVICE_NAME>(), kPadding);
  info.platform = trimmed(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>(), kPadding);
  info.driver_version = trimmed(device.getInfo<CL_DRIVER_VERSION>(), kPadding);
  info.opencl_version = trimmed(device.getInfo<CL_DEVICE_VERSION>(), kPadding);
  info.kind = kind_of(device.getInfo<CL_DEVICE_TYPE>());
  info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.largest_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  info.native_float_lanes = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
  info.loop_limit = loop_limit_of(info);
  info.has_double = device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() != 0;
  if (device.getInfo<CL_DEVICE_LOCAL_MEM_TYPE>() == CL_LOCAL) {
    info.group_memory_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  }
  cl_bool unified = CL_FALSE;
  device.getInfo(CL_DEVICE_HOST_UNIFIED_MEMORY, &unified);
  info.shares_host_memory = info.kind == DeviceKind::cpu && unified == CL_TRUE;
  info.permutes_bytes = permutes_bytes(info);
  return info;
}

void prepare_for_pocl() {
  const char* const path = std::getenv("PATH");
  const std::string others = path == nullptr || *path == '\0' ? "" : std::string(path) + ":";
  ::setenv("PATH", (others + "/usr/bin").c_str(), 1);
  ::setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0);
  ::setenv("HWLOC_PLUGINS_PATH", "/dev/null", 0);
  choose_cache_of_pocl();
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> infos;
  for (const cl::Device& device : all_devices()) infos.push_back(describe_device(device));
  return infos;
}

std::size_t choose_device(std::span<const DeviceInfo> devices, std::string_view wanted) {
  if (wanted.empty()) return 0;
  if (const auto index = parsed<std::size_t>(wanted)) {
    if (*index < devices.size()) return *index;
    throw DeviceError(
        format("there is no OpenCL device {}; these were found:{}", wanted, list_text(devices)));
  }
  const std::vector<std::size_t> matches = named(devices, wanted);
  if (matches.size() == 1) return matches.front();
  throw DeviceError(format("{} OpenCL device's name contains '{}'; these were found:{}",
                           matches.empty() ? "no" : "more than one", wanted, list_text(devices)));
}

bool may_mean_several(std::string_view wanted) {
  return means_all(wanted) || wanted.find(',') != std::string_view::npos;
}

std::vector<std::size_t> choose_devices(std::span<const DeviceInfo> devices, std::string_view wanted) {
  std::vector<std::size_t> chosen;
  if (means_all(wanted)) {
    for (std::size_t i = 0; i < devices.size(); ++i) chosen.push_back(i);
    return chosen;
  }
  if (!may_mean_several(wanted)) return {choose_device(devices, wanted)};
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= wanted.size(); begin += names.back().size() + 1) {
    names.emplace_back(wanted.substr(begin, wanted.find(',', begin) - begin));
    if (!trimmed(names.back()).empty()) continue;
    throw DeviceError(format("'{}' names no device before or after a comma; these were found:{}", wanted,
                             list_text(devices)));
  }
  if (named(devices, wanted).size() == 1) return {choose_device(devices, wanted)};  // a name with a comma
  for (const std::string& name : names) {
    if (means_all(trimmed(name)))
      throw DeviceError(format("'{}' names all devices and some of them; say all, or name some", wanted));
    const std::size_t device = choose_device(devices, trimmed(name));
    if (std::ranges::count(chosen, device) > 0) {
      throw DeviceError(format("'{}' names device {} twice ({}); name each once", wanted, device,
                               devices[device].name));
    }
    chosen.push_back(device);
  }
  return chosen;
}

}  // namespace nutik
