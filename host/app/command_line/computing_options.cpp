#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kGroup = "Computing";

}  // namespace

std::vector<Option> computing_options() {
  return {
      valued(0, "renderer", "NAME", kGroup,
             "opencl, or reference: plain double precision on the processor, slow (default: opencl)",
             kExposes, &Options::renderer),
      valued(0, "device", "NAME", kGroup,
             "OpenCL device by number or part of its name; NUTIK_DEVICE does the same (default: the first "
             "GPU, else the first device)",
             kExposes, &Options::device),
      valued(0, "precision", "NAME", kGroup, "single or double (default: double where the device can)",
             kExposes, &Options::precision),
  };
}

}  // namespace nutik::app
