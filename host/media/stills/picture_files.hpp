// PNG, JPEG and TIFF, through their libraries: what pictures and masks are read from and written to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "capture/picture.hpp"
#include "system/output_file.hpp"

namespace nutik {

struct FileWishes;  // of whoever writes (media/writers/picture_writer.hpp)

// Before a decoder takes memory for what a file states. Deflate makes 1032 bytes of one at most, which may be 8 pixels
// each; a JPEG's block of 64 pixels takes more than that, and a DNG's zeros are packed no closer. Throws InputError.
void check_stated_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::uint64_t file_bytes);

// PNG through libpng.

enum class PngUse { mask, still };

struct PngPicture {
  Picture picture;                 // codes as they lie, grey or RGB, of 8 or 16 bits
  std::vector<std::byte> profile;  // ICC; empty where there is none that can be read
};
// A mask has 8 bits, code for code, no palette, and alpha where that is opaque everywhere; a still has no alpha. Throws
// InputError naming `name` where it is anything else, or damaged. `check_size` is told width and height first; it may
// be empty, and may throw.
[[nodiscard]] PngPicture read_png(std::span<const std::byte> file, const std::string& name, PngUse use,
                                  const std::function<void(std::uint32_t, std::uint32_t)>& check_size = {});

// How a PNG's picture lies, as EXIF numbers it: 1, upright, where its chunk eXIf does not say.
[[nodiscard]] unsigned png_orientation(std::span<const std::byte> file);

// The text under a keyword (Latin-1); nothing where there is none. Throws InputError where the file is damaged.
[[nodiscard]] std::optional<std::string> read_png_text(std::span<const std::byte> file, const char* keyword,
                                                       const std::string& name);

// Writes codes: 8 or 16 bits, grey or RGB; what they mean in the chunks cICP, sRGB or gAMA and cHRM, and in iCCP what
// cICP has no number for; pixels that are not square in pHYs. `text` is kept as picture_text.hpp says; none where it is
// empty.
void write_png(OutputFile& file, const Picture& picture, const std::string& text, const FileWishes&);

// JPEG, through libjpeg.

// 8-bit codes in full colour resolution, quality 1 … 100. What they stand for is in an ICC profile, their pixel aspect
// in the density of the JFIF header, `text` in comments.
void write_jpeg(OutputFile& file, const Picture& picture, const std::string& text, int quality);

struct JpegPicture {
  Picture picture;                                   // codes as they lie, grey or RGB
  std::vector<std::byte> profile;                    // ICC; empty where there is none, or not all of it
  std::optional<std::pair<double, double>> density;  // pixels on a length, across and down
};
// Throws InputError naming `name` where it is neither grey nor RGB, or damaged.
[[nodiscard]] JpegPicture read_jpeg(std::span<const std::byte> file, const std::string& name);

// The comments before the picture, one behind the other; nothing where there is none. Throws InputError.
[[nodiscard]] std::optional<std::string> read_jpeg_comments(std::span<const std::byte> file,
                                                            const std::string& name);

// TIFF through libtiff.

// Writes codes (8 or 16 bits) or light (32- or 64-bit floating point), uncompressed, so that every program
// reads it bit for bit; what values mean as an ICC profile, pixels that are not square as resolution. `text` becomes
// the ImageDescription; none where it is empty. Throws OutputError.
void write_tiff(OutputFile& file, const Picture& picture, const std::string& text, const FileWishes&);
// Each layer is a page, described by its text.
void write_tiff(OutputFile& file, std::span<const PictureLayer> layers);

// The ImageDescription of the first picture; nothing where there is none. Throws InputError where the file is no
// TIFF.
[[nodiscard]] std::optional<std::string> read_tiff_description(const std::filesystem::path& path);

}  // namespace nutik
