// Recordings of Photron's cameras: a .mraw, and the header beside it (photron_header.hpp).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "media/clip.hpp"

namespace nutik {

// The files of a recording that is named by its .mraw or its header: the pictures, then the header, which is the one
// that was named, else what lies beside.
[[nodiscard]] std::optional<std::vector<std::filesystem::path>> photron_files(const std::filesystem::path& path);

// Codes are as stored: values of 8 and 16 bits, the latter with their low byte first, and packed ones of 9 to 15 bits,
// the highest bit first; where a header says that only some bits of a value count, those. Colour is red, green, blue.
// Throws InputError where the header is missing, lacks what is needed, or its pictures are not as many bytes as the
// file has.
[[nodiscard]] std::unique_ptr<Clip> open_photron_clip(const std::filesystem::path& path,
                                                      const std::vector<std::filesystem::path>& files,
                                                      const ClipOptions& options);

}  // namespace nutik
