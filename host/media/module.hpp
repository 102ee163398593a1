// The video libraries are loaded when the first clip is opened, not when the program starts: OpenCV's
// video part and what it needs take 125 ms to load, more than rendering a small capture.
#pragma once

#include <filesystem>
#include <memory>

#include "media/clip.hpp"

namespace nutik {

using OpenVideo = std::unique_ptr<Clip> (*)(const std::filesystem::path&, const ClipOptions&);

// The entry point of nutik-video.so. Looked for in the folder that NUTIK_MODULES names, beside the
// program, and in the installed place. Throws InputError naming where it was looked for.
[[nodiscard]] OpenVideo load_video_module();

}  // namespace nutik
