// PNG through libpng.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "capture/picture.hpp"
#include "system/output_file.hpp"

namespace nutik {

[[nodiscard]] bool is_png(std::span<const std::byte> file);

// Reads a grey picture of 8 bits, code for code. Throws InputError naming `name`, the depth or colour
// type found and the one wanted, where it is anything else.
[[nodiscard]] Picture read_grey_png(std::span<const std::byte> file, const std::string& name);

// Writes codes: 8 or 16 bits, grey or RGB.
void write_png(OutputFile& file, const Picture& picture);

}  // namespace nutik
