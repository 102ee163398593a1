// The libraries that decode and encode are loaded when they are first needed, not when the program starts: FFmpeg's
// take 30 ms, OpenCV's with what they need 55 ms more, as long as rendering a small capture.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "capture/picture.hpp"
#include "media/clip.hpp"
#include "media/stills/stills_table.hpp"
#include "media/writers/video_writer.hpp"
#include "system/output_file.hpp"
#include "system/shared_state.hpp"

namespace nutik {

// What nutik-videos.so gives the program: videos in containers and raw, read and written.
struct VideoModule {
  static constexpr const char* kFile = "nutik-videos.so";
  static constexpr const char* kSymbol = "nutik_video_module";
  static constexpr const char* kWithout = "videos cannot be read or written";

  void (*use_shared_state)(SharedState& of_program);  // first
  std::unique_ptr<Clip> (*open)(const std::filesystem::path& path, const ClipOptions& options);
  std::filesystem::path (*story_beside)(const std::filesystem::path& path);  // videos/capture_rate.hpp
  std::unique_ptr<VideoWriter> (*open_writer)(const std::filesystem::path& path, const VideoFormat& format,
                                              const VideoCodec& codec);
};

// What nutik-stills.so gives the program.
struct StillModule {
  static constexpr const char* kFile = "nutik-stills.so";
  static constexpr const char* kSymbol = "nutik_still_module";
  static constexpr const char* kWithout = "stills cannot be read, nor OpenEXR written";

  void (*use_shared_state)(SharedState& of_program);  // first
  // Stills, one sample each; a TIFF may hold several, but not where `timing` has times for them.
  std::unique_ptr<Clip> (*open)(std::span<const std::filesystem::path> files, const ClipTiming& timing,
                                const ClipOptions& options);
  // When a still was taken and for how long, as far as its EXIF data tell (JPEG, DNG): DateTimeOriginal with
  // SubSecTimeOriginal, and ExposureTime. Nothing for a file without them.
  StillTimes (*read_exif_times)(const std::filesystem::path& file);
  // Light as OpenEXR has it (media/writers/picture_writer.hpp), and the text that such a file carries.
  void (*write_exr)(OutputFile& file, const Picture& picture, const std::string& text, bool as_half);
  // The first is its picture Y, the others channels name.Y; an attribute of each one's name has its text.
  void (*write_exr_layers)(OutputFile& file, std::span<const PictureLayer> layers);
  std::optional<std::string> (*read_exr_text)(const std::filesystem::path& file, const char* keyword);
  // A picture of codes in square pixels (media/writers/picture_writer.hpp).
  Picture (*enlarge)(const Picture& picture, const Shape& shape);
};

// The entry points that stand behind `symbol` in the library `file`; `without` says what lacks without it. It is looked
// for in the folder that NUTIK_MODULES names, beside the program or library that this code is part of, in the installed
// place seen from there, and where the loader looks. Throws InputError naming all of these.
[[nodiscard]] const void* load_module(const char* file, const char* symbol, const char* without);

// A module, loaded by its first use.
template <typename Module>
[[nodiscard]] const Module& module() {
  static const Module* const loaded = [] {
    const auto* found =
        static_cast<const Module*>(load_module(Module::kFile, Module::kSymbol, Module::kWithout));
    found->use_shared_state(shared_state());
    return found;
  }();
  return *loaded;
}

[[nodiscard]] inline const VideoModule& video_module() { return module<VideoModule>(); }
[[nodiscard]] inline const StillModule& still_module() { return module<StillModule>(); }

}  // namespace nutik
