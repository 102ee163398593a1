// What was asked for: every option of the schema (option.hpp) as the value that it stands for.
//
//   always:  until its option is stated, a field is empty or has the option's usual value; `said` tells which options
//            were stated, and in which words
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "align/registrar.hpp"
#include "exposure/shutter_shape.hpp"
#include "features/film/film_request.hpp"
#include "features/masks/mask_request.hpp"
#include "features/sheets/sheet_request.hpp"
#include "features/study/study.hpp"
#include "mask/feather.hpp"
#include "mask/mask_between.hpp"
#include "session/devices.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/output_request.hpp"
#include "session/requests/source_request.hpp"
#include "tik/codec.hpp"

namespace nutik {

struct Option;

// An option by its long name, its value's words, and its row: several commands may mean different things by one name.
struct Said {
  std::string_view option;
  std::vector<std::string> words;
  const Option* row;
};

struct Options {
  using Text = std::optional<std::string>;  // a file's name, or words that only their command understands
  using Time = std::optional<StatedTime>;

  std::string program = "nutik-cl";  // as it was run: by its name, or by a path
  std::vector<std::string> operands;
  std::vector<Said> said;  // every option, in order

  // The source clip: all but its path, its noise and its alignment, which follow from several options.
  SourceRequest source;
  Text noise;  // a file, or kAutomaticNoise
  std::optional<CameraMotion> align;
  Time align_to;
  std::optional<Unseen> unseen;
  Text align_along, align_report, camera_path, camera_plot, coverage;
  tik::Codec codec = tik::kUsualCodec;

  // The exposure, and what is followed or counted: a pixel, or a tag of the mask.
  Text mask, functions, mask_to;
  std::optional<Feather> feather;
  Time start, exposure;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> pixel;
  std::optional<std::uint8_t> tag;
  bool each_tag = false;
  std::optional<ShutterShape> shutter;
  std::optional<double> shutter_error, gain, ev;
  // Its delay, whose picture is not read, its normalization, and of its plan what no other field here says.
  ExposureRequest asked;
  Combining combining;
  std::optional<std::uint32_t> mask_way;  // of kWholeWay
  std::optional<MaskBlend> mask_blend;

  // Many exposures: as a series, on a sheet, as a video's frames.
  Time every;
  std::optional<std::uint64_t> count;
  std::optional<std::uint32_t> columns, width;
  std::vector<SweepRange> sweep;
  Text each;
  std::optional<FrameRanges> frames;
  FramesRequest film;  // its rates and times
  Text curve, video_codec;
  FilmSoundWish sound = FilmSoundWish::as_it_is;

  // How it is computed, and how right that is.
  std::optional<RendererKind> renderer;
  Text device;
  std::optional<Precision> precision;  // none: auto
  bool strict = false;
  std::optional<MemoryBudget> memory;
  Text source_clip;
  std::uint32_t runs = 5;

  // A study; what is solved for.
  StudyRequest study;  // its style, spacing, trail and slit
  Text regions;

  // Masks, plates, and changes over time.
  std::optional<std::uint32_t> by;  // codes
  Text base, preview, uncertain, csv, moment, map;
  std::optional<MaskSize> size;
  bool counts_redrawn = false;

  // What is written.
  Text output, activity;
  OutputRequest picture;
  bool points = false;  // of a function file, printed
  bool json = false, no_recipe = false, quiet = false, verbose = false;
  bool progress = false, skip_existing = false, overwrite = false, in_place = false;

  // What was said of an option, null where nothing was.
  [[nodiscard]] const Said* find(std::string_view option) const {
    const auto found = std::ranges::find(said, option, &Said::option);
    return found == said.end() ? nullptr : &*found;
  }
  [[nodiscard]] bool has(std::string_view option) const { return find(option) != nullptr; }
  // Whether it is left to a command where samples are made between pictures: nobody said so, nor `off`.
  [[nodiscard]] bool joins_by_itself() const { return !has("between"); }
  // The first word of its value; `otherwise` where nothing was said.
  [[nodiscard]] std::string text(std::string_view option, std::string_view otherwise = {}) const {
    const Said* const found = find(option);
    return found != nullptr && !found->words.empty() ? found->words.front() : std::string(otherwise);
  }
};

// Stated for `noise`: measured on the clip itself.
inline constexpr std::string_view kAutomaticNoise = "auto";

}  // namespace nutik
