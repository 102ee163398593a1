// What a file's name says it is.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace nutik {

// The extension with its dot, capitals A to Z made small: `.png` for shot.PNG.
[[nodiscard]] inline std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace nutik
