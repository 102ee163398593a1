// Stills: how they are decoded here. What the functions do stands with media/module.hpp's entries.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "media/clip.hpp"
#include "media/stills_table.hpp"
#include "system/output_file.hpp"

namespace nutik::stills {

[[nodiscard]] std::unique_ptr<Clip> open_still_files(std::span<const std::filesystem::path> files,
                                                     const ClipTiming& timing, const ClipOptions& options);

[[nodiscard]] StillTimes read_exif_times(const std::filesystem::path& file);

// How a picture lies, by EXIF data without the name in front of it: 1 … 8, and 1 where it does not say.
[[nodiscard]] unsigned exif_orientation(std::string_view exif);

void write_exr(OutputFile& file, const Picture& picture, const std::string& text, bool as_half);
[[nodiscard]] std::optional<std::string> read_exr_text(const std::filesystem::path& file,
                                                       const char* keyword);

}  // namespace nutik::stills
