#include <malloc.h>

#include "app/output/console.hpp"
#include "app/requests/requests.hpp"
#include "app/text/number_text.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"

namespace nutik::app {
namespace {

// Lets freed memory go back to the system soon, which is slower than keeping it for the next time. For programs that
// are to keep within little memory; holds for all of the process. Does nothing where the C library has no such choice.
void return_freed_memory() {
#ifdef __GLIBC__
  // Blocks from this size on are mapped, each for itself, and unmapped when they are freed. Otherwise the limit grows
  // to 32 MiB with what is freed, and pictures leave holes in heaps.
  constexpr int kMappedFrom = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kMappedFrom);
  mallopt(M_TRIM_THRESHOLD, 2 * kMappedFrom);
#endif
}

ComputingRequest computing_request(const Options& options) {
  ComputingRequest request = ComputingRequest::of_environment();
  request.memory = memory_budget(options);
  const std::string name = options.renderer.value_or("opencl");
  if (name == "reference") {
    if (options.device) throw UsageError("--device chooses an OpenCL device; the reference uses none");
    if (options.precision) throw UsageError("--precision goes with OpenCL; the reference uses double");
    request.device.clear();
    request.renderer = RendererKind::reference;
    return request;
  }
  if (name != "opencl")
    throw UsageError(format("renderer '{}' is not known; choose opencl or reference", name));
  if (options.device) request.device = *options.device;
  if (options.precision.value_or("auto") != "auto") request.precision = parse_precision(*options.precision);
  return request;
}

}  // namespace

MemoryBudget memory_budget(const Options& options) {
  if (!options.memory) return MemoryBudget::of_machine();
  const std::optional<std::uint64_t> stated = parse_bytes(*options.memory);
  if (!stated || *stated == 0)
    throw UsageError(format("--memory '{}' is no size; write 500MB, 2GB or 1GiB", *options.memory));
  return_freed_memory();
  return MemoryBudget{*stated};
}

std::shared_ptr<Devices> make_devices(const Options& options) {
  return std::make_shared<Devices>(computing_request(options),
                                   options.quiet ? Devices::Announce() : Devices::Announce(print_note));
}

}  // namespace nutik::app
