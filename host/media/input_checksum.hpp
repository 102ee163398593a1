// What the content of a clip, a sequence of stills or a mask is known by again.
//
//   in:      a file, or the files of a sequence in its order
//   out:     text that names its algorithm
//   always:  names and folders count for nothing, but in a table of stills, whose bytes they are
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace nutik {

// Files up to this size together are read whole.
inline constexpr std::uint64_t kWholeChecksumBytes = 256ull << 20;

// `xxh3-64:` and 16 digits: the XXH3-64 of each file's size (u64, little-endian) and bytes, one file behind the
// other. Of more than kWholeChecksumBytes only the size and the first and last bytes of each file are taken, up to
// 1 MiB each, less where there are many: `xxh3-64-ends:`. That costs next to nothing and tells one recording
// from another, but not an edit in the middle that keeps the size. `path` may be a sequence of
// stills (still_sequence.hpp), `is_raw`: a raw video; its files are files_of_clip() (clip.hpp). Throws InputError where
// a file cannot be read.
[[nodiscard]] std::string input_checksum(const std::filesystem::path& path, bool is_raw = false);
// The same of these files.
[[nodiscard]] std::string files_checksum(std::span<const std::filesystem::path> files);

// The same of the bytes of one file.
[[nodiscard]] std::string bytes_checksum(std::span<const std::byte> bytes);

// The name an input is known by: without its folder; for `frames/*.png`, where the folder is part of the
// name, with the last one, unless that is `.` or `..`.
[[nodiscard]] std::string input_name(const std::filesystem::path& path);

}  // namespace nutik
