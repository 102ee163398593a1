// Preloaded before an OpenCL program: lets one call of OpenCL fail, as a device does that is lost or has no room
// (faults/fault.hpp). Kinds of calls:
//
//   start      contexts, queues, kernels
//   build      programs, from their source or from what was kept of them
//   allocate   buffers
//   arguments  what a kernel is given
//   enqueue    launches, copies, fills
//   wait       for commands: they have run, and then it is said that they failed
//
// What a driver does within is not seen.
// As the program does.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>

#include "faults/fault.hpp"

namespace {

using nutik::test::fault_of;

// The function of this name and type behind this library.
template <typename Function>
Function* next(Function* /*like*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// What a call that makes something returns where it fails.
std::nullptr_t failed(cl_int error, cl_int* said) {
  if (said != nullptr) *said = error;
  return nullptr;
}

}  // namespace

#define NUTIK_NEXT(name) next(name, #name)

extern "C" {

cl_context clCreateContext(const cl_context_properties* properties, cl_uint count,
                           const cl_device_id* devices,
                           void(CL_CALLBACK* notify)(const char*, const void*, size_t, void*), void* user,
                           cl_int* said) {
  if (const int error = fault_of("start", CL_OUT_OF_HOST_MEMORY)) return failed(error, said);
  return NUTIK_NEXT(clCreateContext)(properties, count, devices, notify, user, said);
}

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device,
                                      cl_command_queue_properties properties, cl_int* said) {
  if (const int error = fault_of("start", CL_OUT_OF_HOST_MEMORY)) return failed(error, said);
  return NUTIK_NEXT(clCreateCommandQueue)(context, device, properties, said);
}

cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* said) {
  if (const int error = fault_of("start", CL_OUT_OF_HOST_MEMORY)) return failed(error, said);
  return NUTIK_NEXT(clCreateKernel)(program, name, said);
}

cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** strings,
                                     const size_t* lengths, cl_int* said) {
  if (const int error = fault_of("build", CL_OUT_OF_HOST_MEMORY)) return failed(error, said);
  return NUTIK_NEXT(clCreateProgramWithSource)(context, count, strings, lengths, said);
}

cl_program clCreateProgramWithBinary(cl_context context, cl_uint count, const cl_device_id* devices,
                                     const size_t* lengths, const unsigned char** binaries, cl_int* each,
                                     cl_int* said) {
  if (const int error = fault_of("build", CL_OUT_OF_HOST_MEMORY)) return failed(error, said);
  return NUTIK_NEXT(clCreateProgramWithBinary)(context, count, devices, lengths, binaries, each, said);
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                      void(CL_CALLBACK* notify)(cl_program, void*), void* user) {
  if (const int error = fault_of("build", CL_BUILD_PROGRAM_FAILURE)) return error;
  return NUTIK_NEXT(clBuildProgram)(program, count, devices, options, notify, user);
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t bytes, void* host, cl_int* said) {
  if (const int error = fault_of("allocate", CL_MEM_OBJECT_ALLOCATION_FAILURE)) return failed(error, said);
  return NUTIK_NEXT(clCreateBuffer)(context, flags, bytes, host, said);
}

cl_mem clCreateSubBuffer(cl_mem buffer, cl_mem_flags flags, cl_buffer_create_type type, const void* region,
                         cl_int* said) {
  if (const int error = fault_of("allocate", CL_MEM_OBJECT_ALLOCATION_FAILURE)) return failed(error, said);
  return NUTIK_NEXT(clCreateSubBuffer)(buffer, flags, type, region, said);
}

cl_int clSetKernelArg(cl_kernel kernel, cl_uint index, size_t bytes, const void* value) {
  if (const int error = fault_of("arguments", CL_OUT_OF_HOST_MEMORY)) return error;
  return NUTIK_NEXT(clSetKernelArg)(kernel, index, bytes, value);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* size, const size_t* group, cl_uint count,
                              const cl_event* events, cl_event* event) {
  if (const int error = fault_of("enqueue", CL_OUT_OF_RESOURCES)) return error;
  return NUTIK_NEXT(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, size, group, count, events,
                                            event);
}

cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool waits, size_t offset, size_t bytes,
                            const void* from, cl_uint count, const cl_event* events, cl_event* event) {
  if (const int error = fault_of("enqueue", CL_OUT_OF_RESOURCES)) return error;
  return NUTIK_NEXT(clEnqueueWriteBuffer)(queue, buffer, waits, offset, bytes, from, count, events, event);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool waits, size_t offset, size_t bytes,
                           void* to, cl_uint count, const cl_event* events, cl_event* event) {
  if (const int error = fault_of("enqueue", CL_OUT_OF_RESOURCES)) return error;
  return NUTIK_NEXT(clEnqueueReadBuffer)(queue, buffer, waits, offset, bytes, to, count, events, event);
}

cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern, size_t pattern_bytes,
                           size_t offset, size_t bytes, cl_uint count, const cl_event* events,
                           cl_event* event) {
  if (const int error = fault_of("enqueue", CL_OUT_OF_RESOURCES)) return error;
  return NUTIK_NEXT(clEnqueueFillBuffer)(queue, buffer, pattern, pattern_bytes, offset, bytes, count, events,
                                         event);
}

cl_int clEnqueueWriteBufferRect(cl_command_queue queue, cl_mem buffer, cl_bool waits, const size_t* buffer_at,
                                const size_t* host_at, const size_t* region, size_t buffer_row,
                                size_t buffer_slice, size_t host_row, size_t host_slice, const void* from,
                                cl_uint count, const cl_event* events, cl_event* event) {
  if (const int error = fault_of("enqueue", CL_OUT_OF_RESOURCES)) return error;
  return NUTIK_NEXT(clEnqueueWriteBufferRect)(queue, buffer, waits, buffer_at, host_at, region, buffer_row,
                                              buffer_slice, host_row, host_slice, from, count, events, event);
}

cl_int clEnqueueReadBufferRect(cl_command_queue queue, cl_mem buffer, cl_bool waits, const size_t* buffer_at,
                               const size_t* host_at, const size_t* region, size_t buffer_row,
                               size_t buffer_slice, size_t host_row, size_t host_slice, void* to,
                               cl_uint count, const cl_event* events, cl_event* event) {
  if (const int error = fault_of("enqueue", CL_OUT_OF_RESOURCES)) return error;
  return NUTIK_NEXT(clEnqueueReadBufferRect)(queue, buffer, waits, buffer_at, host_at, region, buffer_row,
                                             buffer_slice, host_row, host_slice, to, count, events, event);
}

cl_int clEnqueueCopyBuffer(cl_command_queue queue, cl_mem from, cl_mem to, size_t from_at, size_t to_at,
                           size_t bytes, cl_uint count, const cl_event* events, cl_event* event) {
  if (const int error = fault_of("enqueue", CL_OUT_OF_RESOURCES)) return error;
  return NUTIK_NEXT(clEnqueueCopyBuffer)(queue, from, to, from_at, to_at, bytes, count, events, event);
}

cl_int clFinish(cl_command_queue queue) {
  const int error = fault_of("wait", CL_OUT_OF_RESOURCES);
  const cl_int finished = NUTIK_NEXT(clFinish)(queue);
  return error != 0 ? error : finished;
}

cl_int clWaitForEvents(cl_uint count, const cl_event* events) {
  const int error = fault_of("wait", CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
  const cl_int waited = NUTIK_NEXT(clWaitForEvents)(count, events);
  return error != 0 ? error : waited;
}

}  // extern "C"
