#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kGroup = "Computing";

}  // namespace

std::vector<Option> computing_options() {
  return {
      one_of(valued(0, "renderer", "NAME", kGroup,
                    "opencl, or reference: plain double precision on the processor, slow (default: opencl)",
                    kExposes, &Options::renderer),
             {"opencl", "reference"}),
      valued(0, "device", "NAME", kGroup,
             "OpenCL device by number or part of its name; NUTIK_DEVICE does the same (default: the first "
             "GPU, else the first device)",
             kExposes | bit(CommandId::validate), &Options::device),
      one_of(
          valued(0, "precision", "NAME", kGroup,
                 "single, compensated, double, fixed (the same bytes on every device), or auto: the fastest "
                 "that is sure to be right to half a code, or to half a float's step (default: auto; see -v)",
                 kExposes, &Options::precision),
          {"auto", "single", "compensated", "double", "fixed"}),
      valued(
          0, "memory", "SIZE", kGroup,
          "what pictures and blocks may take: 500MB, 2GB, 1GiB; libraries take some 150 MB besides (default: "
          "half of the machine's)",
          kReadsClips | kExposes, &Options::memory),
  };
}

}  // namespace nutik::app
