// What is read of PNGs and JPEGs, through their libraries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "media/formats/picture_format.hpp"

namespace nutik {

// Before a decoder takes memory for what a file states. Deflate makes 1032 bytes of one at most, which may be 8 pixels
// each; a JPEG's block of 64 pixels takes more than that, and a DNG's zeros are packed no closer. Throws InputError.
void check_stated_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::uint64_t file_bytes);

enum class PngUse { mask, still };

// A mask has 8 bits, code for code, no palette, and alpha where that is opaque everywhere; of a still it is left out.
// Throws InputError naming `name` where it is anything else, or damaged. `check_size` is told width and height first;
// it may be empty, and may throw.
[[nodiscard]] FilePicture read_png(std::span<const std::byte> file, const std::string& name, PngUse use,
                                   const std::function<void(std::uint32_t, std::uint32_t)>& check_size = {});

// How a PNG's picture lies, as EXIF numbers it: 1, upright, where its chunk eXIf does not say.
[[nodiscard]] unsigned png_orientation(std::span<const std::byte> file);

// 8-bit codes with profile and density. Throws InputError naming `name` where it is neither grey nor RGB, or damaged.
[[nodiscard]] FilePicture read_jpeg(std::span<const std::byte> file, const std::string& name);

}  // namespace nutik
