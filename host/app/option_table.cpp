#include "app/option_table.hpp"

#include <algorithm>
#include <vector>

#include "app/commands.hpp"

namespace nutik::app {
namespace {

using Id = CommandId;

// Pointers to the members that hold a value; flags have their own setter.
Option valued(char short_name, std::string_view long_name, std::string_view value, std::string_view group,
              std::string_view help, CommandSet commands, std::optional<std::string> Options::*member) {
  return {short_name,
          long_name,
          value,
          group,
          help,
          commands,
          [member](Options& options, const std::string& text) { options.*member = text; }};
}

Option flag(char short_name, std::string_view long_name, std::string_view group, std::string_view help,
            CommandSet commands, bool Options::*member) {
  return {short_name, long_name, {}, group, help, commands, [member](Options& options, const std::string&) {
            options.*member = true;
          }};
}

constexpr CommandSet kEncode = bit(Id::encode);
constexpr CommandSet kExpose = bit(Id::expose);
constexpr CommandSet kAll = ~CommandSet{0};

constexpr std::string_view kSource = "The source clip";
constexpr std::string_view kExposure = "The exposure";
constexpr std::string_view kComputing = "Computing";
constexpr std::string_view kOutput = "Output";

}  // namespace

std::string Option::display_name() const {
  return short_name != 0 ? std::string{'-', short_name} : "--" + std::string(long_name);
}

std::span<const Command> commands() {
  static const std::vector<Command> table{
      {Id::encode, "encode", "CLIP [CAPTURE.tik]",
       "Turn a video or a sequence of stills into a .tik capture: for every pixel, a record of each change "
       "of its value.",
       "nutik-cl clip.mp4 clip.tik\n"
       "nutik-cl -f 960 -a 180 slowmotion.mp4 clip.tik\n"
       "nutik-cl encode --tolerance 4 -o small.tik clip.mp4\n"
       "nutik-cl -f 30000 --white 4095 'frames/*.png' capture.tik\n"
       "nutik-cl -f 500 frame%04d.tif capture.tik",
       run_encode},
      {Id::expose, "expose", "CAPTURE.tik|CLIP [PICTURE]",
       "Expose a picture: each pixel is the integral of its light times a gain function of time.",
       "nutik-cl --start 0.4s --exposure 10ms clip.tik moment.png\n"
       "nutik-cl -k trail.fn clip.tik trail.png\n"
       "nutik-cl -m regions.pgm -k regions.fn clip.tik picture.tif --depth 16\n"
       "nutik-cl -m regions.pgm -k difference.fn clip.tik -o light.pfm",
       run_expose},
      {Id::info, "info", "CAPTURE.tik", "Say what a capture holds.",
       "nutik-cl info clip.tik\n"
       "nutik-cl info --activity map.png clip.tik",
       run_info},
      {Id::devices, "devices", "", "List the OpenCL devices that --device can choose from.",
       "nutik-cl devices", run_devices},
      {Id::recover, "recover", "DAMAGED.tik WHOLE.tik",
       "Save the whole blocks of a .tik file that was cut off.", "nutik-cl recover damaged.tik -o whole.tik",
       run_recover},
  };
  return table;
}

const Command& command(CommandId id) {
  return *std::find_if(commands().begin(), commands().end(),
                       [&](const Command& entry) { return entry.id == id; });
}

const Command* find_command(std::string_view name) {
  const auto found = std::find_if(commands().begin(), commands().end(),
                                  [&](const Command& entry) { return entry.name == name; });
  return found == commands().end() ? nullptr : &*found;
}

std::span<const Option> options() {
  static const std::vector<Option> table{
      valued('f', "fps", "RATE", kSource,
             "pictures a second that the clip was filmed with: 120, 29.97, 30000/1001 (default: what the "
             "file says)",
             kEncode | kExpose, &Options::fps),
      valued('a', "shutter-angle", "DEGREES", kSource,
             "share of the time between pictures that the shutter was open, 360 being all of it "
             "(default: 360)",
             kEncode | kExpose, &Options::shutter_angle),
      valued(0, "white", "CODE", kSource,
             "the code that stands for white: 255, 4095 for 12 bits, … (default: what the file says)",
             kEncode | kExpose, &Options::white),
      valued(0, "transfer", "NAME", kSource,
             "how codes stand for light: srgb, bt709, linear or gamma:G (default: srgb; linear for stills "
             "and grey video of more than 8 bits and for 16-bit colour; what deep or raw video names; a "
             ".tik's own)",
             kEncode | kExpose, &Options::transfer),
      valued(0, "raw", "WxH:FORMAT", kSource,
             "a video without a header: its size and FFmpeg's name of its pixels, 480x270:yuv420p10le",
             kEncode | kExpose, &Options::raw),
      valued(0, "tolerance", "CODES", kSource,
             "differences up to this many codes are no change; 0 keeps every one (default: 0)",
             kEncode | kExpose, &Options::tolerance),

      valued('k', "functions", "FILE.fn", kExposure,
             "the gain functions, one for each mask value; a file with a single one needs no mask", kExpose,
             &Options::functions),
      valued('m', "mask", "FILE.pgm", kExposure,
             "which function each pixel is exposed with: an 8-bit grey PGM or PNG", kExpose, &Options::mask),
      valued(0, "start", "TIME", kExposure,
             "expose a plain interval from here on: 0.4s, 400ms, 2/5s, 37f for pictures of the clip", kExpose,
             &Options::start),
      valued(0, "exposure", "TIME", kExposure,
             "length of the plain interval: 10ms, 1/100s, 250us, or 3f, to the end of the third picture",
             kExpose, &Options::exposure),
      valued(0, "unmapped", "zero", kExposure,
             "expose mask values without a function to black (default: an error)", kExpose,
             &Options::unmapped),
      valued(0, "live", "all", kExposure,
             "visit every sample, also where no gain needs it (the picture is the same)", kExpose,
             &Options::live),

      valued(0, "renderer", "NAME", kComputing,
             "opencl, or reference: plain double precision on the processor, slow (default: opencl)", kExpose,
             &Options::renderer),
      valued(0, "device", "NAME", kComputing,
             "OpenCL device by number or part of its name; NUTIK_DEVICE does the same (default: the first "
             "GPU, else the first device)",
             kExpose, &Options::device),
      valued(0, "precision", "NAME", kComputing,
             "single, compensated, double, fixed (the same bytes on every device), or auto: the fastest that is "
             "sure to be right to half a code, or to half a float's step (default: auto; see -v)",
             kExpose, &Options::precision),

      valued('o', "output", "FILE", kOutput,
             "where to write; without it the last operand, or a name made from the inputs",
             kEncode | kExpose | bit(Id::recover), &Options::output),
      valued(0, "depth", "BITS", kOutput,
             "8, 16 or float: light as it is, with negatives (default: the capture's own, float for .pfm)",
             kExpose, &Options::depth),
      valued(
          0, "codec", "NAME", kOutput,
          "pack blocks with none (large, quickest to expose), lz4, zstd or zstd:1 … zstd:19 (default: zstd)",
          kEncode, &Options::codec),
      valued(0, "tiles", "KIND", kOutput,
             "auto, or all tiles as dense, rows or records, for experiments (default: auto)",
             kEncode | kExpose, &Options::tiles),
      valued(0, "block-samples", "N", kOutput, "samples in a block (default: 64, fewer for large pictures)",
             kEncode | kExpose, &Options::block_samples),
      valued(0, "activity", "MAP.png", kOutput,
             "also write how often each pixel changes, as a grey picture: black never, white most often, "
             "between them sRGB",
             bit(Id::info), &Options::activity),
      flag('q', "quiet", kOutput, "no progress bar and no summary", kAll, &Options::quiet),
      flag('v', "verbose", kOutput, "also say in which precision and why, how fast and with how much memory", kExpose,
           &Options::verbose),
  };
  return table;
}

const Option* find_option(std::string_view long_name) {
  const auto found = std::find_if(options().begin(), options().end(),
                                  [&](const Option& option) { return option.long_name == long_name; });
  return found == options().end() ? nullptr : &*found;
}

const Option* find_option(char short_name) {
  const auto found = std::find_if(options().begin(), options().end(), [&](const Option& option) {
    return option.short_name != 0 && option.short_name == short_name;
  });
  return found == options().end() ? nullptr : &*found;
}

}  // namespace nutik::app
