// The ways in which clips are decoded here, and videos encoded.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "media/clip.hpp"
#include "media/clips/probe.hpp"
#include "media/stills_table.hpp"
#include "media/video_writer.hpp"

namespace nutik::clips {

// 8-bit colour.
[[nodiscard]] std::unique_ptr<Clip> open_with_opencv(const std::filesystem::path& path, const Probe& probe);

// Grey and deeper video, whose depth OpenCV's reader would lose.
[[nodiscard]] std::unique_ptr<Clip> open_with_libav(const std::filesystem::path& path, const Probe& probe,
                                                    const ClipOptions& options);

// Stills, one sample each; a TIFF may hold several, but not where `timing` has times for them.
[[nodiscard]] std::unique_ptr<Clip> open_still_files(std::span<const std::filesystem::path> files,
                                                     const ClipTiming& timing, const ClipOptions& options);

// When a still was taken and for how long, as far as its EXIF data tell (JPEG): DateTimeOriginal with
// SubSecTimeOriginal, and ExposureTime. Nothing for a file without them.
[[nodiscard]] StillTimes read_exif_times(const std::filesystem::path& file);

// Videos in containers.
[[nodiscard]] std::unique_ptr<VideoWriter> open_libav_writer(const std::filesystem::path& path,
                                                             const VideoFormat& format,
                                                             const VideoCodec& codec);

}  // namespace nutik::clips
