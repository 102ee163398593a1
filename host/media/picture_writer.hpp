// Pictures to files, by extension.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "capture/picture.hpp"

namespace nutik {

// How many bits a person asked for: codes, or light as floating point.
enum class Depth { bits8, bits16, floating };
[[nodiscard]] Depth parse_depth(std::string_view text);  // `8`, `16`, `float`; throws UsageError

// The value type that a picture of `channels` takes in a file of this name. Without a wish it is `usual`
// (codes of the capture's own depth) where the file holds codes, else light. Throws UsageError where the
// extension is not known, or the file cannot hold what was asked for, naming what can.
[[nodiscard]] ValueType value_type_for(const std::filesystem::path& path, std::optional<Depth> wish,
                                       ValueType usual, std::uint32_t channels);

// Whether the name's extension is one that write_picture() knows.
[[nodiscard]] bool is_picture_name(const std::filesystem::path& path);

// Writes a picture whole or not at all, with what its values mean and a line of text where its format has a place for
// them (picture_text.hpp).
// Throws OutputError.
void write_picture(const std::filesystem::path& path, const Picture& picture, const std::string& text = {});

}  // namespace nutik
