// The line of text that a picture carries beside its values: how it was made.
//
//   PNG        text chunk with the keyword nutik-cl (tEXt)
//   TIFF       ImageDescription
//   PGM, PPM   a comment behind the first line
//   JPEG       comments (COM), as many as it takes
//   OpenEXR    the attribute nutik-cl
//   PFM        nowhere: the format has no place for it
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace nutik {

class OutputFile;

inline constexpr const char* kPictureTextKeyword = "nutik-cl";
// What such a text starts with, which tells it from what others write in the same place.
inline constexpr std::string_view kPictureTextStart = "{\"nutik-cl\":";

// How long such a text may be, for pictures come from anyone and a PNG's text may be compressed a thousandfold.
inline constexpr std::size_t kMaxPictureTextBytes = std::size_t{64} << 20;

// Nothing where the picture carries no such text. Throws InputError where the file cannot be read, is no
// picture of these formats, is cut off before the text, or the text is longer than kMaxPictureTextBytes.
[[nodiscard]] std::optional<std::string> read_picture_text(const std::filesystem::path& path);

// The field `file` of such a text, behind the program's version, tells whether its file is as it was written: it is the
// XXH3-64 of all other bytes of the file, but for the checksum of the PNG's chunk that the text is in. Until then:
inline constexpr std::string_view kUnsealed = "xxh3-64:0000000000000000";
// Puts it in, where the text of the written file has the field. Throws OutputError.
void seal_picture(OutputFile& file);
// False where it has no such field, too. Throws InputError where the file cannot be read.
[[nodiscard]] bool is_as_sealed(const std::filesystem::path& path);

}  // namespace nutik
