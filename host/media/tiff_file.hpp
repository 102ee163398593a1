// TIFF through libtiff.
#pragma once

#include <filesystem>

#include "capture/picture.hpp"

namespace nutik {

// Writes codes (8 or 16 bits) or light (32-bit floating point), uncompressed, so that every program
// reads it bit for bit. Throws OutputError.
void write_tiff(const std::filesystem::path& path, const Picture& picture);

}  // namespace nutik
