// What files are by how they begin: the kinds of stills, and kinds that nothing here reads, which are refused by name
// whichever way they come in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "media/formats/readers.hpp"

namespace nutik {

// What a file is and what can be done about it, as a sentence that begins with its name. Empty where readers may look at
// it.
[[nodiscard]] std::optional<std::string> unread_kind_text(const std::filesystem::path& file);

// Throws InputError with that.
void refuse_unread_kind(const std::filesystem::path& file);

// Throws InputError where a file holds nothing but text, which some video readers would draw as a screen of letters.
void refuse_text(const std::filesystem::path& file);

// The kind of still that a file is: by its first bytes, else by its name. Null if neither tells one.
[[nodiscard]] const readers::Reader* still_kind(const std::filesystem::path& file);

// A number of so many bytes, the most significant first; 0 where they are not all there.
[[nodiscard]] std::uint64_t big_endian(std::string_view bytes, std::size_t at, std::size_t count);

// Whether PNGs or JPEGs stand in it one behind the other, or an animated PNG: a video, whatever its name ends with.
[[nodiscard]] bool holds_several_pictures(const std::filesystem::path& file);

// Where Sony's cameras write what they know of a clip: C0001M01.XML beside C0001.MP4. Empty for clips of other kinds.
[[nodiscard]] std::filesystem::path sony_file_of(const std::filesystem::path& clip);

// Before a decoder takes memory for what a file states. Deflate makes 1032 bytes of one at most, which may be 8 pixels
// each; a JPEG's block of 64 pixels takes more than that, and a DNG's zeros are packed no closer. Throws InputError.
void check_stated_size(const std::string& name, std::uint64_t width, std::uint64_t height, std::uint64_t file_bytes);

}  // namespace nutik
