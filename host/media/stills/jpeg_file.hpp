// JPEG, through libjpeg.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "system/output_file.hpp"

namespace nutik {

// 8-bit codes in full colour resolution, quality 1 … 100. What they stand for is in an ICC profile, their pixel aspect
// in the density of the JFIF header, `text` in comments.
void write_jpeg(OutputFile& file, const Picture& picture, const std::string& text, int quality);

[[nodiscard]] bool is_jpeg(std::span<const std::byte> file);

// The comments before the picture, one behind the other; nothing where there is none. Throws InputError.
[[nodiscard]] std::optional<std::string> read_jpeg_comments(std::span<const std::byte> file,
                                                            const std::string& name);

// The ICC profile; empty where there is none, or not all of it. Throws InputError.
[[nodiscard]] std::vector<std::byte> read_jpeg_profile(std::span<const std::byte> file,
                                                       const std::string& name);

}  // namespace nutik
