// TIFF through libtiff.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "capture/picture.hpp"

namespace nutik {

// Writes codes (8 or 16 bits) or light (32-bit floating point), uncompressed, so that every program
// reads it bit for bit; what values mean as an ICC profile, pixels that are not square as resolution. `text` becomes
// the ImageDescription; none where it is empty. Throws OutputError.
void write_tiff(const std::filesystem::path& path, const Picture& picture, const std::string& text);

// The ImageDescription of the first picture; nothing where there is none. Throws InputError where the file is no
// TIFF.
[[nodiscard]] std::optional<std::string> read_tiff_description(const std::filesystem::path& path);

}  // namespace nutik
