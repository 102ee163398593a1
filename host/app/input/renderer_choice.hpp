// The renderer that the options ask for.
#pragma once

#include <memory>

#include "app/command_line/options.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/renderer.hpp"

namespace nutik::app {

// Throws UsageError for an unknown name, DeviceError where the device is absent.
[[nodiscard]] std::unique_ptr<Renderer> choose_renderer(const Options& options);

// The OpenCL device that they ask for, whatever --renderer says. Throws DeviceError where it is absent.
[[nodiscard]] std::unique_ptr<OpenClRenderer> start_device(const Options& options);

}  // namespace nutik::app
