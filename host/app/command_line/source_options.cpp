#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

using Id = CommandId;

constexpr std::string_view kGroup = "The source clip";

}  // namespace

std::vector<Option> source_options() {
  return {
      valued('f', "fps", "RATE", kGroup,
             "pictures a second that the clip was filmed with: 120, 29.97, 30000/1001 (default: what the "
             "file says)",
             kReadsClips | bit(Id::shutter), &Options::fps),
      valued('a', "shutter-angle", "DEGREES", kGroup,
             "share of the time between pictures that the shutter was open, 360 being all of it "
             "(default: 360)",
             kReadsClips | bit(Id::shutter), &Options::shutter_angle),
      valued(0, "white", "CODE", kGroup,
             "the code that stands for white: 255, 4095 for 12 bits, … (default: what the file says)",
             kDecodesClips, &Options::white),
      one_of(
          valued(
              0, "transfer", "NAME", kGroup,
              "how codes stand for light: srgb, bt709, linear or gamma:G (default: srgb; linear for stills "
              "and grey video of more than 8 bits and for 16-bit colour; what deep or raw video names; a "
              ".tik's own)",
              kDecodesClips, &Options::transfer),
          {"srgb", "bt709", "linear", "gamma:"}),
      valued(0, "raw", "WxH:FORMAT", kGroup,
             "a video without a header: its size and FFmpeg's name of its pixels, 480x270:yuv420p10le",
             kDecodesClips, &Options::raw),
      valued(0, "tolerance", "CODES", kGroup,
             "differences up to this many codes are no change; 0 keeps every one (default: 0)", kEncodesClips,
             &Options::tolerance),
      one_of(valued(0, "noise", "FILE|auto", kGroup,
                    "the camera's noise, as nutik-cl noise measures it, or auto: measured on the clip "
                    "itself. What is "
                    "within it is no change, and samples are held as the light they are expected to have",
                    kReadsClips, &Options::noise),
             {"auto"}),
      valued(0, "sigmas", "K", kGroup,
             "with --noise: standard deviations from what is held within which a sample is no change "
             "(default: 3)",
             kReadsClips, &Options::sigmas),
  };
}

}  // namespace nutik::app
