#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kGroup = "The exposure";

}  // namespace

std::vector<Option> exposure_options() {
  return {
      valued('k', "functions", "FILE.fn", kGroup,
             "the gain functions, one for each mask value; a file with a single one needs no mask",
             kExposesFunctions, &Options::functions),
      valued('m', "mask", "FILE.pgm", kGroup,
             "which function each pixel is exposed with: an 8-bit grey PGM or PNG", kExposesFunctions,
             &Options::mask),
      valued(0, "start", "TIME", kGroup,
             "expose a plain interval from here on: 0.4s, 400ms, 2/5s, 37f for pictures of the clip",
             kExposesFunctions, &Options::start),
      valued(0, "exposure", "TIME", kGroup,
             "length of the plain interval: 10ms, 1/100s, 250us, or 3f, to the end of the third picture",
             kExposesFunctions, &Options::exposure),
      valued(0, "unmapped", "zero", kGroup,
             "expose mask values without a function to black (default: an error)", kExposesFunctions,
             &Options::unmapped),
      valued(0, "live", "all", kGroup,
             "visit every sample, also where no gain needs it (the picture is the same)", kExposesFunctions,
             &Options::live),
  };
}

}  // namespace nutik::app
