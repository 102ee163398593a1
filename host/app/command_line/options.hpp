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

struct Options {
  std::string program = "nutik-cl";  // as it was run: by its name, or by a path
  std::vector<std::string> operands;
  std::vector<Said> said;  // every option, in the order of the command line

  // The source clip.
  std::optional<std::string> fps;
  std::optional<std::string> shutter_angle;
  std::optional<std::string> white;
  std::optional<std::string> transfer;
  std::optional<std::string> raw;
  std::optional<std::string> noise;
  std::optional<std::string> sigmas;

  // The exposure.
  std::optional<std::string> mask;
  std::optional<std::string> functions;
  std::optional<std::string> start;
  std::optional<std::string> exposure;
  std::optional<std::string> unmapped;
  std::optional<std::string> live;
  std::optional<std::string> pixel;
  std::optional<std::string> tag;  // of a mask
  std::optional<std::string> shutter;
  std::optional<std::string> shutter_error;
  std::optional<std::string> normalize;
  std::optional<std::string> gain;
  std::optional<std::string> ev;

  // Many exposures, as a series or on a sheet.
  std::optional<std::string> every;
  std::optional<std::string> count;
  std::optional<std::string> columns;
  std::optional<std::string> width;
  std::optional<std::string> shift;
  std::optional<std::string> scale_gain;
  std::optional<std::string> stretch;
  std::optional<std::string> each;

  // How it is computed.
  std::optional<std::string> renderer;
  std::optional<std::string> device;
  std::optional<std::string> precision;
  std::optional<std::string> memory;

  // How right it is.
  std::optional<std::string> source;
  std::optional<std::string> runs;

  // The file.
  std::optional<std::string> output;
  std::optional<std::string> depth;
  std::optional<std::string> negative;
  std::optional<std::string> tolerance;
  std::optional<std::string> codec;
  std::optional<std::string> tiles;
  std::optional<std::string> block_samples;
  std::optional<std::string> activity;

  // Masks.
  std::optional<std::string> by;
  std::optional<std::string> base;
  std::optional<std::string> size;
  std::optional<std::string> preview;

  // Changes over time.
  std::optional<std::string> csv;
  std::optional<std::string> moment;
  std::optional<std::string> map;

  // A video's frames.
  std::optional<std::string> out_fps;
  std::optional<std::string> out_angle;
  std::optional<std::string> from;
  std::optional<std::string> to;
  std::optional<std::string> speed;
  std::optional<std::string> video_codec;

  bool json = false;
  bool no_recipe = false;
  bool quiet = false;
  bool verbose = false;
};

}  // namespace nutik::app
