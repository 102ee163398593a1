// Formats of clips: which files are of each, and how they are opened; open_clip.cpp has their table. What is believed of
// each stands in media/formats/readers.hpp.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "media/clip.hpp"
#include "media/formats/readers.hpp"

namespace nutik {

using Files = std::vector<std::filesystem::path>;

struct ClipFormat {
  const readers::Reader* reader;  // one that tells of it
  // What a name stands for if it is of this format. Throws InputError if that is damaged or not all there.
  std::optional<Files> (*files)(const std::filesystem::path& path);
  std::unique_ptr<Clip> (*open)(const std::filesystem::path& path, const Files& files, const ClipOptions& options);
};

// Photron's recordings (cameras/photron_clip.cpp), named by their .mraw or their header: the pictures, then the header,
// which is the one that was named, else what lies beside.
[[nodiscard]] std::optional<Files> photron_files(const std::filesystem::path& path);
// Codes are as stored: values of 8 and 16 bits, the latter with their low byte first, and packed ones of 9 to 15 bits, the
// highest bit first; where a header says that only some bits of a value count, those. Colour is red, green, blue. Throws
// InputError where the header is missing, lacks what is needed, or its pictures are not as many bytes as the file has.
[[nodiscard]] std::unique_ptr<Clip> open_photron_clip(const std::filesystem::path& path, const Files& files,
                                                      const ClipOptions& options);

}  // namespace nutik
