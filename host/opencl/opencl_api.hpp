// The OpenCL C++ bindings, included the same way everywhere in this room and nowhere else.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wignored-attributes"
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#include <CL/opencl.hpp>
#pragma GCC diagnostic pop

#include <string>
#include <vector>

#include "capture/error.hpp"
#include "opencl/device.hpp"

namespace nutik {

// An OpenCL error as a sentence: what was being done, the call and its code by name.
std::string describe(const cl::Error& error, const std::string& doing);

// The same with the way out, for what may happen to any device.
DeviceError device_failed(const cl::Error& error, const std::string& doing);

// All devices in the order of list_devices().
std::vector<cl::Device> all_devices();
DeviceInfo describe_device(const cl::Device& device);

}  // namespace nutik
