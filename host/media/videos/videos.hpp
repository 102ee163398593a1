// Videos, in containers and raw: how they are decoded here, and encoded.
#pragma once

#include <filesystem>
#include <memory>

#include "media/clip.hpp"
#include "media/writers/video_writer.hpp"
#include "media/videos/probe.hpp"

namespace nutik::videos {

[[nodiscard]] std::unique_ptr<Clip> open_with_libav(const std::filesystem::path& path, const Probe& probe,
                                                    const ClipOptions& options);

// Into containers.
[[nodiscard]] std::unique_ptr<VideoWriter> open_libav_writer(const std::filesystem::path& path,
                                                             const VideoFormat& format,
                                                             const VideoCodec& codec);

}  // namespace nutik::videos
