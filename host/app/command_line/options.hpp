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
  using Value = std::optional<std::string>;

  std::string program = "nutik-cl";  // as it was run: by its name, or by a path
  std::vector<std::string> operands;
  std::vector<Said> said;  // every option, in the order of the command line

  // The source clip.
  Value fps, shutter_angle, white, transfer, matrix, range, chroma_at, primaries, pixel_aspect, raw, noise,
      sigmas;
  Value clip_from, clip_to, crop, scale, deinterlace;
  bool as_far_as_it_goes = false;
  bool counts_redrawn = false;
  bool deflicker = false;
  Value tolerance, codec, tiles, block_samples;
  Value align, align_to, align_along, unseen, camera_path, camera_plot, coverage;

  // The exposure, and what is followed or counted: a pixel, or a tag of the mask.
  Value mask, feather, delay, functions, start, exposure, unmapped, live, pixel, tag;
  Value shutter, shutter_error, normalize, gain, ev;
  Value mask_to, mask_share, mask_blend;

  // Many exposures: as a series, on a sheet, as a video's frames.
  Value every, count, columns, width, shift, scale_gain, stretch, each;
  Value out_fps, out_angle, from, to, speed, curve, frames, video_codec;

  // How it is computed, and how right that is.
  Value renderer, device, precision, memory, source, runs;

  // A study; what is solved for.
  Value style, moments, spacing, trail, slit_from, regions;

  // Masks, plates, and changes over time.
  Value by, base, size, preview, uncertain, csv, moment, map;

  // What is written.
  Value output, depth, quality, negative, out_transfer, activity;
  bool json = false, no_recipe = false, quiet = false, verbose = false;
  bool progress = false, skip_existing = false, overwrite = false, in_place = false;

  // A recording of events.
  Value contrast, start_picture, tick;
};

}  // namespace nutik::app
