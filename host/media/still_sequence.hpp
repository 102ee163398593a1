// Which files a sequence of stills is made of.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace nutik {

// The files that `path` stands for where it is a sequence of stills or a single still:
//   a folder            every picture in it, in the order a person counts (2 before 10)
//   `frames/*.png`      every file that matches (*, ? in the file name), in that order
//   `frame%04d.png`     numbered files, from the lowest number on
//   a picture           that file (a TIFF may hold several pictures)
// Empty optional: `path` is none of these (a video, presumably). Throws InputError where it is one but no
// file is there, or numbers of a numbered sequence are missing.
[[nodiscard]] std::optional<std::vector<std::filesystem::path>> list_stills(
    const std::filesystem::path& path);

}  // namespace nutik
