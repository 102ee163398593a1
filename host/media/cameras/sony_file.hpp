// Where Sony's cameras write what they know of a clip: C0001M01.XML beside C0001.MP4.
#pragma once

#include <filesystem>
#include <string>

#include "media/formats/extension.hpp"

namespace nutik {

// Empty for clips of other kinds.
[[nodiscard]] inline std::filesystem::path sony_file_of(const std::filesystem::path& clip) {
  const std::string extension = extension_of(clip);
  if (extension != ".mxf" && extension != ".mp4") return {};  // an export of another kind has other codes
  return clip.parent_path() / (clip.stem().string() + "M01.XML");
}

}  // namespace nutik
