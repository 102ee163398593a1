// Which files a sequence of stills is made of.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace nutik {

// The files that `path` stands for where it is a sequence of stills or a single still:
//   a folder            every picture in it that is not hidden, in the order a person counts (2 before
//                       10); all must be of one kind of file. If most are numbered alike, these are it; two numbered
//                       sequences are none
//   `frames/*.png`      every file that matches (*, ? and [a-z], as shells have them), in that order
//   `frame%04d.png`     numbered files as printf writes them, from the lowest number on
//   a picture           that file (a TIFF may hold several pictures)
//   stills.csv          the files that the table lists, for whoever asks which are read; open_clip() opens it as a
//                       table
// Empty optional: `path` is none of these (a video, presumably). Throws InputError where it is one but no
// file is there, or numbers of a numbered sequence are missing.
[[nodiscard]] std::optional<std::vector<std::filesystem::path>> list_stills(
    const std::filesystem::path& path);

// What to tell of a folder whose pictures, in their order, are numbered with a hole: a sentence that names the
// first that is missing and the way out. Empty where none is missing, or names do not count pictures: they
// differ in more than one number, or go up by this and that.
[[nodiscard]] std::optional<std::string> missing_still_note(const std::filesystem::path& folder,
                                                            std::span<const std::filesystem::path> files);

// Which pictures of a pattern have names of another kind than most, as what was made in their folder has.
[[nodiscard]] std::optional<std::string> mixed_note(const std::filesystem::path& pattern,
                                                    std::span<const std::filesystem::path> files);

// What to tell of a folder of which some pictures are not among its sequence; empty where all are.
[[nodiscard]] std::optional<std::string> left_out_note(const std::filesystem::path& folder,
                                                       std::span<const std::filesystem::path> files);

// Whether a new file in a folder would be read as one of its stills, or would, with another of its kind, keep them from
// being read.
[[nodiscard]] bool joins_stills(const std::filesystem::path& folder, const std::filesystem::path& file);

// What to call that which is made from a clip: `clip` for clip.mp4, `frames` for the folder frames/
// and for frames/*.png, `shot` for shot_%04d.png.
[[nodiscard]] std::string sequence_name(const std::filesystem::path& path);

}  // namespace nutik
