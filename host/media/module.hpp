// The libraries that decode and encode clips are loaded when the first is opened, not when the program starts:
// OpenCV's video part and what it needs take 125 ms to load, more than rendering a small capture.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "media/clip.hpp"
#include "media/stills_table.hpp"
#include "media/video_writer.hpp"

namespace nutik {

// The entry points of nutik-clips.so.
struct ClipModule {
  std::unique_ptr<Clip> (*open_video)(const std::filesystem::path& path, const ClipOptions& options);
  std::unique_ptr<Clip> (*open_stills)(std::span<const std::filesystem::path> files, const ClipTiming& timing,
                                       const ClipOptions& options);
  StillTimes (*read_exif_times)(const std::filesystem::path& file);
  std::unique_ptr<VideoWriter> (*open_video_writer)(const std::filesystem::path& path,
                                                    const VideoFormat& format, const VideoCodec& codec);
};

// Looks for the module in the folder that NUTIK_MODULES names, beside the program, and in the installed
// place. Throws InputError naming where it was looked for.
[[nodiscard]] const ClipModule& load_clip_module();

// The symbol that gives a module's entry points.
inline constexpr const char* kClipModuleSymbol = "nutik_clip_module";

}  // namespace nutik
