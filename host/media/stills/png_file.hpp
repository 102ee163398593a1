// PNG through libpng.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "system/output_file.hpp"

namespace nutik {

[[nodiscard]] bool is_png(std::span<const std::byte> file);

// Reads a picture of 8 bits, grey or colour, code for code; alpha is left out where it is opaque everywhere. Throws
// InputError naming `name`, the depth or colour type found and the one wanted, where it is anything else.
// `check_size` is told width and height first; it may be empty, and may throw.
[[nodiscard]] Picture read_8_bit_png(
    std::span<const std::byte> file, const std::string& name,
    const std::function<void(std::uint32_t, std::uint32_t)>& check_size = {});

// The text under a keyword (Latin-1); nothing where there is none. Throws InputError where the file is damaged.
[[nodiscard]] std::optional<std::string> read_png_text(std::span<const std::byte> file, const char* keyword,
                                                       const std::string& name);

// The ICC profile; empty where there is none that can be read. Throws InputError where the file is damaged.
[[nodiscard]] std::vector<std::byte> read_png_profile(std::span<const std::byte> file,
                                                      const std::string& name);

// Writes codes: 8 or 16 bits, grey or RGB; what they mean in the chunks cICP, sRGB or gAMA and cHRM, and in iCCP what
// cICP has no number for; pixels that are
// not square in pHYs. `text` is kept as picture_text.hpp says; none where it is empty.
void write_png(OutputFile& file, const Picture& picture, const std::string& text);

}  // namespace nutik
