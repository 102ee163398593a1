// Tells a file's kind by its first bytes. Kinds that are not supported are refused with a way out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "media/formats/input_kinds.hpp"

namespace nutik {

// The first bytes of a file, by which its kind is told; none where its name says that nothing stands in front of its
// pixels, as of Photron's.
[[nodiscard]] std::string telling_bytes(const std::filesystem::path& file);

// What a file is and what can be done about it, as a sentence that begins with its name. Empty where it may be
// supported.
[[nodiscard]] std::optional<std::string> unsupported_kind_text(const std::filesystem::path& file);

// Throws InputError with that.
void refuse_unsupported_kind(const std::filesystem::path& file);

// What the studio's projects are named by.
inline constexpr const char* kProjectExtension = ".nutik";
// Throws InputError where a file's name says that it is one.
void refuse_project(const std::filesystem::path& file);

// Throws InputError where a file is a project, or holds nothing but text, which some video readers would draw as a
// screen of letters.
void refuse_text(const std::filesystem::path& file);

// The kind of still that a file is: by its first bytes, else by its name. Null if neither tells one.
[[nodiscard]] const inputs::InputKind* still_kind(const std::filesystem::path& file);
// By its name alone.
[[nodiscard]] const inputs::InputKind* kind_named_by(const std::filesystem::path& file);
// `PNG, JPEG, …`: all of them, or those of which this is so.
[[nodiscard]] std::string still_kinds_text(bool inputs::InputKind::*which = nullptr);

// `*.mraw *.cih …`: names of clips that are no videos, as dialogs have them.
[[nodiscard]] std::string clip_patterns();

// Whether PNGs or JPEGs stand in it one behind the other, or an animated PNG: a video, whatever its name ends with.
[[nodiscard]] bool holds_several_pictures(const std::filesystem::path& file);

}  // namespace nutik
