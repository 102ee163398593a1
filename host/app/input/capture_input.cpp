#include "app/input/capture_input.hpp"

#include <array>

#include "app/command_line/option_table.hpp"
#include "app/input/noise_choice.hpp"
#include "app/requests/source_words.hpp"
#include "app/text/number_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/mapped_file.hpp"
#include "tik/header.hpp"

namespace nutik::app {
namespace {

// Rates up to this are what players show; a clip filmed faster often says one of them.
constexpr double kHighestPlaybackRate = 60.0;

constexpr double kLeastSigmas = 0.1, kLargestSigmas = 100;

RawVideo parse_raw_video(const std::string& text) {
  const auto cross = text.find('x');
  const auto colon = text.find(':');
  if (cross == std::string::npos || colon == std::string::npos || colon < cross) {
    throw UsageError(
        format("raw video '{}' is not described; write its size and pixel format, as in "
               "480x270:yuv420p10le",
               text));
  }
  constexpr std::uint32_t kLargestSide = 65'536;
  return {parse_whole_number(text.substr(0, cross), "width", 1, kLargestSide),
          parse_whole_number(text.substr(cross + 1, colon - cross - 1), "height", 1, kLargestSide),
          text.substr(colon + 1)};
}

}  // namespace

bool is_tik(const std::filesystem::path& path) {
  const std::string start = first_bytes(path);
  return tik::looks_like_tik(std::as_bytes(std::span(start))) || path.extension() == ".tik";
}

SourceOptions SourceOptions::from(const Options& options) {
  SourceOptions source;
  if (options.fps) source.clip.rate = Rational::parse(*options.fps, "frame rate");
  if (options.shutter_angle) {
    source.shutter_angle = Rational::parse(*options.shutter_angle, "shutter angle");
    source.angle_was_stated = true;
  }
  if (options.white) source.clip.white_code = parse_whole_number(*options.white, "white code", 1, 65'535);
  if (options.raw) source.clip.raw = parse_raw_video(*options.raw);
  if (options.transfer) source.clip.transfer = Transfer::parse(*options.transfer);
  if (options.tolerance) {
    source.noise.tolerance = parse_whole_number(*options.tolerance, "tolerance", 0, 65'535);
  }
  if (options.noise && options.tolerance) {
    throw UsageError("--noise and --tolerance both say what is no change; leave one out");
  }
  if (options.sigmas && !options.noise) {
    throw UsageError(
        "--sigmas counts standard deviations of a camera's noise: it needs --noise FILE or --noise auto");
  }
  source.noise_source = options.noise;
  if (options.sigmas)
    source.noise.sigmas = parse_number(*options.sigmas, "sigmas", kLeastSigmas, kLargestSigmas);
  if (options.tiles) source.tiles = parse_tile_policy(*options.tiles);
  if (options.block_samples) {
    source.block_samples =
        parse_whole_number(*options.block_samples, "block length", 1, kLargestBlockSamples);
  }
  source.memory = memory_budget(options);
  // Made here so that a senseless rate or angle is refused before anything is opened.
  static_cast<void>(Timeline::constant(source.clip.rate.value_or(Rational{1, 1}), source.shutter_angle, 1));
  return source;
}

CaptureFormat clip_format(const Clip& clip, const SourceOptions& options) {
  CaptureFormat capture = clip.info().format;
  if (options.clip.transfer) capture.transfer = *options.clip.transfer;
  if (options.clip.white_code) {
    if (capture.code_bytes == 1 && *options.clip.white_code > 255) {
      throw UsageError(format("white code {} does not fit the clip's 8-bit codes (255 at most)",
                              *options.clip.white_code));
    }
    capture.white_code = *options.clip.white_code;
  }
  return capture;
}

SourceClip open_source(const std::filesystem::path& path, const SourceOptions& options) {
  SourceClip source;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && std::filesystem::is_other(status)) {
    throw InputError(
        format("{} is no regular file: a clip is read more than once; save the stream to a file first",
               path.string()));
  }
  source.clip = open_clip(path, options.clip);
  if (options.angle_was_stated && !options.clip.rate && !source.clip->info().timing.exposures.empty()) {
    throw UsageError(
        format("{} says how long each picture was exposed; leave --shutter-angle out, or the "
               "exposure_ns column empty",
               path.string()));
  }
  source.capture = clip_format(*source.clip, options);
  source.notes = source.clip->info().notes;
  source.capture.noise = options.noise;
  if (options.noise_source == kAutomaticNoise) {
    std::vector<std::string> known;  // the clip is this one
    const NoiseEstimate estimate =
        measure_noise(std::array{path.string()}, options, kAutomaticNoiseSamples, known);
    source.capture.noise.camera = estimate.noise;
    for (const std::string& note : noise_notes(estimate)) source.notes.push_back(note);
  } else if (options.noise_source) {
    source.capture.noise.camera = read_noise_file(*options.noise_source);
    if (auto note =
            transfer_note(*options.noise_source, *source.capture.noise.camera, source.capture.transfer))
      source.notes.push_back(std::move(*note));
  }
  source.block_samples = options.block_samples.value_or(
      default_block_samples(source.capture, std::min(kDefaultBlockBytes, options.memory.block_bytes())));
  // A block takes memory for the samples it may hold: no more than there are.
  const std::uint64_t announced = source.clip->info().sample_count;
  if (announced != 0 && announced < source.block_samples) {
    source.block_samples = static_cast<std::uint32_t>(announced);
  }
  options.memory.check(source.capture, source.block_samples);
  return source;
}

std::string timing_text(const Timeline& timeline, const SourceOptions& options) {
  const std::string rate =
      options.clip.rate ? format("{} pictures a second (--fps)", timeline.rate().text())
      : timeline.is_constant()
          ? format("{} pictures a second (from the file)", timeline.rate().text())
          : format("irregular times (from the file), {:.4g} pictures a second on average",
                   timeline.rate().value());
  return format("{}, shutter {} degrees ({})", rate, timeline.shutter_angle().text(),
                options.angle_was_stated                            ? "--shutter-angle"
                : timeline.shutter_angle() != options.shutter_angle ? "mean of the listed exposures"
                                                                    : "assumed");
}

std::vector<std::string> note_lines(const std::vector<std::string>& notes, const Timeline& timeline,
                                    const SourceOptions& options) {
  std::vector<std::string> lines;
  for (const std::string& note : notes) lines.push_back(format("note: {}", note));
  if (!options.clip.rate && timeline.rate().value() <= kHighestPlaybackRate) {
    lines.push_back(format(
        "note: the rate of {} a second comes from the file; slow-motion files state their playback rate: "
        "if it was filmed faster, say so with --fps",
        timeline.rate().text()));
  }
  return lines;
}

void refuse_source_options(const Options& options, const std::string& capture) {
  for (const Option& option : app::options()) {
    if (!option.describes_clip() || !option.is_in(options)) continue;
    throw UsageError(
        format("{} describes a clip that is encoded; {} was encoded already. Encode the clip again with it",
               option.name(), capture));
  }
}

}  // namespace nutik::app
