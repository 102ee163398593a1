// Pictures to files, by extension.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "capture/picture.hpp"
#include "media/formats/picture_format.hpp"

namespace nutik {

// How many bits a person asked for: codes, or light as floating point of 16, 32 or 64 bits.
enum class Depth { bits8, bits16, half, floating, doubled };

// The value type that a picture of `channels` takes in a file of this name. Without a wish it is `usual`
// (codes of the capture's own depth, or 8 bits where the file holds no more) where the file holds codes, else light.
// Throws UsageError where the extension is not known, or the file cannot hold what was asked for, naming what can.
[[nodiscard]] ValueType value_type_for(const std::filesystem::path& path, std::optional<Depth> wish,
                                       ValueType usual, std::uint32_t channels);

// Whether a name stands for standard output: `-`, a PNG, or `exr:-` with the extension of another kind.
[[nodiscard]] bool names_standard_output(const std::filesystem::path& path);
// `.png` of shot.PNG and of `png:-`.
[[nodiscard]] std::string picture_extension(const std::filesystem::path& path);
// Whether the name's extension is one that write_picture() knows.
[[nodiscard]] bool is_picture_name(const std::filesystem::path& path);
// Whether it is one of files whose codes are near those of the picture, as near as a quality says.
[[nodiscard]] bool is_lossy_name(const std::filesystem::path& path);
// Whether it is one of files that do not tell what their values mean.
[[nodiscard]] bool is_silent_name(const std::filesystem::path& path);
// Whether it is one of files that have a place for a line of text.
[[nodiscard]] bool has_text_by_name(const std::filesystem::path& path);
// `.png, .tif, … or .npy`: those extensions.
[[nodiscard]] std::string picture_extensions();
// `*.png *.tif …`: the same, as dialogs have them.
[[nodiscard]] std::string picture_patterns();

// That files hold where pixels are made square.
inline constexpr std::uint32_t kLargestSquaredSide = 65'500;
// The size that a picture of codes, whose pixels are `aspect` times as wide as high, has in a file of this name.
[[nodiscard]] Shape written_shape(const std::filesystem::path& path, const Shape& shape, const Rational& aspect,
                                  const FileWishes& wishes);
// The picture in square pixels, if their size is not its own.
[[nodiscard]] Picture in_square_pixels(const Picture& picture, const Shape& shape);

// Writes a picture whole or not at all, to a file or to standard output, with what its values mean and a line of text
// where its format has a place for them (picture_text.hpp).
// Throws OutputError, UsageError where such a file cannot hold the picture.
void write_picture(const std::filesystem::path& path, const Picture& picture, const std::string& text = {},
                   const FileWishes& wishes = {});
// The same of layers, of which a .pfm holds the first alone.
void write_layers(const std::filesystem::path& path, std::span<const PictureLayer> layers);

}  // namespace nutik
