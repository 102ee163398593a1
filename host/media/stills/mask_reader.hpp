// Masks from files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "capture/picture.hpp"

namespace nutik {

// Told the size that a mask states, before anything is allocated for it; may throw.
using CheckMaskSize = std::function<void(std::uint32_t width, std::uint32_t height)>;

// Reads an 8-bit grey picture (PGM, PPM, PNG), or one of colour whose channels agree in every pixel, tags taken
// literally: a maximum other than 255 does not rescale them. A PNG is turned upright as its eXIf says. Throws an
// InputError that says what was found and what is needed.
[[nodiscard]] Picture read_mask(const std::filesystem::path& path);

// The same of bytes that messages call `name`.
[[nodiscard]] Picture read_mask(std::span<const std::byte> bytes, const std::string& name,
                                const CheckMaskSize& check_size = {});

// What painting programs save as colour, all three channels being the tag, as grey of as many bits. Throws InputError
// naming `name` where they differ.
[[nodiscard]] Picture grey_of(Picture&& picture, const std::string& name);

}  // namespace nutik
