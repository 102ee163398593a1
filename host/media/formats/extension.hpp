// What a file's name says it is.
#pragma once

#include <filesystem>
#include <string>

#include "capture/text.hpp"

namespace nutik {

// The extension with its dot, capitals A to Z made small: `.png` for shot.PNG.
[[nodiscard]] inline std::string extension_of(const std::filesystem::path& path) {
  return in_small_letters(path.extension().string());
}

}  // namespace nutik
