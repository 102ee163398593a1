// The capture that a command works on: a .tik, or a clip that is turned into one while it is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/command_line/options.hpp"
#include "imev/capture_source.hpp"
#include "media/clip.hpp"
#include "session/memory_budget.hpp"
#include "tik/reader.hpp"

namespace nutik::app {

// Whether a file is to be read as a .tik: by its content, else by its name.
[[nodiscard]] bool is_tik(const std::filesystem::path& path);

// Stated for --noise: measured on the clip itself.
inline constexpr std::string_view kAutomaticNoise = "auto";

// What is stated about a clip on the command line.
struct SourceOptions {
  ClipOptions clip;
  Rational shutter_angle = Timeline::kFullShutter;
  bool angle_was_stated = false;
  NoiseModel noise;                         // without the camera's, which may be the clip's own
  std::optional<std::string> noise_source;  // of the camera's: a file's name, or kAutomaticNoise
  TilePolicy tiles = TilePolicy::automatic;
  std::optional<std::uint32_t> block_samples;
  MemoryBudget memory;

  // Throws UsageError where a value makes no sense.
  static SourceOptions from(const Options& options);
};

// A clip's format as it is or as it was stated, without noise. Throws UsageError where the white code that was
// stated does not fit its codes.
[[nodiscard]] CaptureFormat clip_format(const Clip& clip, const SourceOptions& options);

// A clip and how it is to be encoded.
struct SourceClip {
  std::unique_ptr<Clip> clip;
  CaptureFormat capture;  // of its samples; what is held of them has held_format()
  std::uint32_t block_samples = 0;
  std::vector<std::string> notes;  // on the clip and its noise: what a person should know
};

[[nodiscard]] SourceClip open_source(const std::filesystem::path& path, const SourceOptions& options);

// `120 pictures a second (--fps), shutter 180 degrees (--shutter-angle)`: what a timeline was made from.
[[nodiscard]] std::string timing_text(const Timeline& timeline, const SourceOptions& options);

// What else a person should know of a clip, as lines: the `notes` on it, and that a low rate from a file may not be the
// rate it was filmed with.
[[nodiscard]] std::vector<std::string> note_lines(const std::vector<std::string>& notes,
                                                  const Timeline& timeline, const SourceOptions& options);

// The errors of options that describe a clip, for a .tik, which has been described already.
void refuse_source_options(const Options& options, const std::string& capture);

}  // namespace nutik::app
