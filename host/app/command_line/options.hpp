// Everything that can be said on the command line, as it was said.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nutik::app {

// An option by its long name, and its value's words.
struct Said {
  std::string_view option;
  std::vector<std::string> words;
};

// What was stated, if anything; it is parsed where it becomes a request.
using Stated = std::optional<std::string>;

struct Options {
  std::string program = "nutik-cl";  // as it was run: by its name, or by a path
  std::vector<std::string> operands;
  std::vector<Said> said;  // every option, in the order of the command line

  // The source clip, and how it is encoded.
  Stated fps, shutter_angle, white, transfer, raw, tolerance, noise, sigmas, tiles, block_samples, codec;
  // The exposure.
  Stated mask, functions, start, exposure, unmapped, live, shutter, shutter_error, normalize, gain, ev;
  Stated depth, negative;
  // Many exposures: a series, a sheet, a sweep, a video.
  Stated every, count, columns, width, shift, scale_gain, stretch, each;
  Stated out_fps, out_angle, from, to, speed, video_codec;
  // What else is looked at, or drawn.
  Stated pixel, tag, by, moment, base, size, source, runs;
  // How it is computed.
  Stated renderer, device, precision, memory;
  // What is written.
  Stated output, activity, preview, csv, map;

  bool json = false, no_recipe = false, quiet = false, verbose = false;
};

}  // namespace nutik::app
