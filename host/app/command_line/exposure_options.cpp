#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

using Id = CommandId;

constexpr std::string_view kGroup = "The exposure";

}  // namespace

std::vector<Option> exposure_options() {
  return {
      valued('k', "functions", "FILE.fn", kGroup,
             "the gain functions, one for each mask value; a file with a single one needs no mask; - is "
             "standard input",
             kTakesFunctions, &Options::functions),
      valued('m', "mask", "FILE.pgm", kGroup,
             "which function each pixel is exposed with: an 8-bit grey PGM or PNG; - is standard input",
             kTakesMasks, &Options::mask),
      valued(0, "start", "TIME", kGroup,
             "expose a plain interval from here on: 0.4s, 400ms, 2/5s, 37f for pictures of the clip; with -k "
             "the "
             "functions' time 0 (default: 0s)",
             kTakesIntervals | bit(Id::shutter), &Options::start),
      valued(0, "exposure", "TIME", kGroup,
             "length of the plain interval: 10ms, 1/100s, 250us, or 3f, to the end of the third picture",
             kTakesIntervals | bit(Id::shutter), &Options::exposure),
      one_of(valued(0, "unmapped", "zero", kGroup,
                    "expose mask values without a function to black (default: an error)", kTakesFunctions,
                    &Options::unmapped),
             {"zero"}),
      one_of(valued(0, "live", "all", kGroup,
                    "visit every sample, also where no gain needs it (the picture is the same)",
                    kTakesFunctions & ~bit(Id::check), &Options::live),
             {"all"}),
      valued(0, "pixel", "X,Y", kGroup, "the pixel to follow, counted from 0 at the top left", bit(Id::trace),
             &Options::pixel),
      valued(0, "tag", "VALUE", kGroup, "follow the mean of all pixels that have this value in the mask",
             bit(Id::trace), &Options::tag),
      one_of(
          valued(
              0, "shutter", "SHAPE", kGroup,
              "how far the shutter is open in the course of the plain interval: box, trapezoid:R, triangle, "
              "gaussian, hann, strobe:N[,R] or spline:0=G,…,1=G (default: box)",
              kShapesExposures, &Options::shutter),
          {"box", "trapezoid:", "triangle", "gaussian", "hann", "strobe:", "spline:"}),
      valued(0, "shutter-error", "E", kGroup,
             "how far a smooth shape may be from its true gains, as a share of the largest (default: 0.001)",
             kShapesExposures | bit(Id::shutter), &Options::shutter_error),
      one_of(
          valued(
              0, "normalize", "BY", kGroup,
              "divide by the time with a gain (support), by its integral (integral: a still scene keeps its "
              "brightness), by that of its magnitude (absolute), or by seconds:S (default: support)",
              kShapesExposures, &Options::normalize),
          {"support", "integral", "absolute", "seconds:"}),
      valued(0, "gain", "G", kGroup, "make the light G times as much (default: 1)",
             kShapesExposures | bit(Id::shutter), &Options::gain),
      valued(0, "ev", "E", kGroup, "make the light 2^E times as much: 1 is one stop brighter (default: 0)",
             kShapesExposures | bit(Id::shutter), &Options::ev),
      valued(
          0, "every", "TIME", kGroup,
          "expose a series, each picture this much later than the one before: 40ms, 2f; name it out-%03d.png",
          bit(Id::expose), &Options::every),
      valued(0, "count", "N", kGroup, "pictures in the series (default: as many as fit in the capture)",
             bit(Id::expose), &Options::count),
      valued(0, "tag", "VALUE", kGroup, "the mask value that the function belongs to: 0 … 255 (default: 0)",
             bit(Id::shutter), &Options::tag),
  };
}

}  // namespace nutik::app
