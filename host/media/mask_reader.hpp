// Masks from files.
#pragma once

#include <filesystem>

#include "capture/picture.hpp"

namespace nutik {

// Reads an 8-bit picture with one channel (PGM P2 or P5, PNG), tags taken literally: a maximum other
// than 255 does not rescale them. Throws InputError that says what was found and what is needed.
[[nodiscard]] Picture read_mask(const std::filesystem::path& path);

}  // namespace nutik
