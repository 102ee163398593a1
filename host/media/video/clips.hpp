// The two ways in which videos are decoded here.
#pragma once

#include <filesystem>
#include <memory>

#include "media/clip.hpp"
#include "media/video/probe.hpp"

namespace nutik::video {

// 8-bit colour.
[[nodiscard]] std::unique_ptr<Clip> open_with_opencv(const std::filesystem::path& path,
                                                     const Probe& probe);

// Grey and deeper video, whose depth OpenCV's reader would lose.
[[nodiscard]] std::unique_ptr<Clip> open_with_libav(const std::filesystem::path& path,
                                                    const Probe& probe, const ClipOptions& options);

}  // namespace nutik::video
