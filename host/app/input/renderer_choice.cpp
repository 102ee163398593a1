#include "app/input/renderer_choice.hpp"

#include <cstdlib>

#include "app/input/memory_budget.hpp"
#include "app/output/console.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/device.hpp"
#include "opencl/program_store.hpp"
#include "render/reference_renderer.hpp"

namespace nutik::app {

std::unique_ptr<OpenClRenderer> start_device(const Options& options) {
  const char* environment = std::getenv("NUTIK_DEVICE");
  const std::string wanted = options.device.value_or(environment != nullptr ? environment : "");
  const std::vector<DeviceInfo> devices = list_devices();
  OpenClOptions opencl;
  opencl.device = choose_device(devices, wanted);
  if (options.precision.value_or("auto") != "auto") opencl.precision = parse_precision(*options.precision);
  opencl.memory_bytes = MemoryBudget::from(options).rendering_bytes();
  opencl.cache_folder = default_cache_folder();
  if (!options.quiet) opencl.announce = print_note;
  return std::make_unique<OpenClRenderer>(opencl);
}

std::unique_ptr<Renderer> choose_renderer(const Options& options) {
  const std::string name = options.renderer.value_or("opencl");
  if (name == "reference") {
    if (options.device) throw UsageError("--device chooses an OpenCL device; the reference uses none");
    if (options.precision) throw UsageError("--precision goes with OpenCL; the reference uses double");
    return std::make_unique<ReferenceRenderer>();
  }
  if (name != "opencl") {
    throw UsageError(format("renderer '{}' is not known; choose opencl or reference", name));
  }
  return start_device(options);
}

}  // namespace nutik::app
