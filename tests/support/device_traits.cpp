// The first device as another one: what OpenCL says of it is changed on the way to the program that is tested, so that
// what only such a device runs is run on every machine. For programs that are linked with this file.
//
//   NUTIK_TEST_DEVICE=gpu,single,allocation=1000000,group=8    any of them
//
//   gpu          has its own memory, work-items for lanes, and memory beside each group. A buffer in the host's memory
//                is refused, which a card would copy for each launch
//   single       has no double
//   allocation   allocates so many bytes at a time and no more
//   group        runs so many work-items of a kernel in a group and no more
//   transfer     takes so many milliseconds for each copy to it of a megabyte or more, besides the copying
//
// Kernels are the machine's own. That those without double need none is held where they are compiled
// (kernels/CMakeLists.txt).
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

namespace nutik::test {
std::function<void()> before_waiting;  // called where the program begins to wait for a command
}

namespace {

struct Traits {
  bool is_gpu = false;
  bool is_single = false;
  std::uint64_t allocation_bytes = 0;  // 0: the device's own
  std::size_t group_items = 0;         // likewise
  std::chrono::milliseconds transfer{0};

  Traits() {
    const char* wanted = std::getenv("NUTIK_TEST_DEVICE");
    for (std::string_view rest = wanted == nullptr ? "" : wanted; !rest.empty();) {
      const std::string_view word = rest.substr(0, rest.find(','));
      rest.remove_prefix(std::min(rest.size(), word.size() + 1));
      if (word == "gpu") {
        is_gpu = true;
      } else if (word == "single") {
        is_single = true;
      } else if (word.starts_with("allocation=")) {
        allocation_bytes = std::stoull(std::string(word.substr(word.find('=') + 1)));
      } else if (word.starts_with("group=")) {
        group_items = std::stoull(std::string(word.substr(word.find('=') + 1)));
      } else if (word.starts_with("transfer=")) {
        transfer = std::chrono::milliseconds(std::stoi(std::string(word.substr(word.find('=') + 1))));
      } else {
        std::fprintf(stderr, "NUTIK_TEST_DEVICE is not of gpu, single, allocation=BYTES, group=N, transfer=MS: %s\n",
                     wanted);
        std::abort();
      }
    }
  }
};

const Traits& traits() {
  static const Traits of_environment;
  return of_environment;
}

// The function of this name behind this program.
template <typename Function>
Function* next(Function* /*like*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

template <typename Value>
void change(void* value, Value to) {
  if (value != nullptr) std::memcpy(value, &to, sizeof to);
}

}  // namespace

extern "C" {

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t room, void* value, size_t* bytes) {
  static const auto real = next(&clGetDeviceInfo, "clGetDeviceInfo");
  const cl_int error = real(device, what, room, value, bytes);
  if (error != CL_SUCCESS) return error;
  if (traits().is_gpu) {
    if (what == CL_DEVICE_TYPE) change(value, cl_device_type{CL_DEVICE_TYPE_GPU});
    if (what == CL_DEVICE_HOST_UNIFIED_MEMORY) change(value, cl_bool{CL_FALSE});
    if (what == CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT) change(value, cl_uint{1});
    if (what == CL_DEVICE_LOCAL_MEM_TYPE) change(value, cl_device_local_mem_type{CL_LOCAL});
  }
  if (traits().is_single && what == CL_DEVICE_DOUBLE_FP_CONFIG) change(value, cl_device_fp_config{0});
  if (traits().allocation_bytes != 0 && what == CL_DEVICE_MAX_MEM_ALLOC_SIZE) {
    change(value, cl_ulong{traits().allocation_bytes});
  }
  return error;
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t bytes, void* host, cl_int* said) {
  static const auto real = next(&clCreateBuffer, "clCreateBuffer");
  cl_int error = CL_SUCCESS;
  if (traits().allocation_bytes != 0 && bytes > traits().allocation_bytes) error = CL_INVALID_BUFFER_SIZE;
  if (traits().is_gpu && (flags & CL_MEM_USE_HOST_PTR) != 0) error = CL_INVALID_HOST_PTR;
  if (error == CL_SUCCESS) return real(context, flags, bytes, host, said);
  if (said != nullptr) *said = error;
  return nullptr;
}

cl_int clGetKernelWorkGroupInfo(cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info what, size_t room,
                                void* value, size_t* bytes) {
  static const auto real = next(&clGetKernelWorkGroupInfo, "clGetKernelWorkGroupInfo");
  const cl_int error = real(kernel, device, what, room, value, bytes);
  if (error == CL_SUCCESS && traits().group_items != 0 && what == CL_KERNEL_WORK_GROUP_SIZE) {
    change(value, traits().group_items);
  }
  return error;
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                              const size_t* items, const size_t* group, cl_uint wait_count, const cl_event* waits,
                              cl_event* event) {
  static const auto real = next(&clEnqueueNDRangeKernel, "clEnqueueNDRangeKernel");
  if (traits().group_items != 0 && group != nullptr && *group > traits().group_items) return CL_INVALID_WORK_GROUP_SIZE;
  return real(queue, kernel, dimensions, offset, items, group, wait_count, waits, event);
}

cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocks, size_t offset, size_t bytes,
                            const void* from, cl_uint wait_count, const cl_event* waits, cl_event* event) {
  static const auto real = next(&clEnqueueWriteBuffer, "clEnqueueWriteBuffer");
  if (bytes >= 1 << 20) std::this_thread::sleep_for(traits().transfer);
  return real(queue, buffer, blocks, offset, bytes, from, wait_count, waits, event);
}

cl_int clWaitForEvents(cl_uint count, const cl_event* events) {
  static const auto real = next(&clWaitForEvents, "clWaitForEvents");
  if (nutik::test::before_waiting) nutik::test::before_waiting();
  return real(count, events);
}

}  // extern "C"
