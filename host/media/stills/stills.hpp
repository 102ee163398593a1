// Stills: how they are decoded here. What the functions do stands with media/module.hpp's entries.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "media/clip.hpp"
#include "media/stills_table.hpp"

namespace nutik::stills {

[[nodiscard]] std::unique_ptr<Clip> open_still_files(std::span<const std::filesystem::path> files,
                                                     const ClipTiming& timing, const ClipOptions& options);

[[nodiscard]] StillTimes read_exif_times(const std::filesystem::path& file);

}  // namespace nutik::stills
