// Tables of stills: a row for each picture with when it was taken and for how long.
//
//   file,start_ns,exposure_ns        this line may be left out
//   a.png,0,10000000
//   b.png,40000000,20000000          a gap of 30 ms after a.png
//   "c, 2.png",,                     both from the file's EXIF data
//
// CSV as spreadsheets write it: fields with commas or quotes stand in quotes; blank lines, a byte-order mark
// and CRLF are accepted. Files are relative to the table's folder. Columns at a row's end may be missing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "media/clip.hpp"

namespace nutik {

// A time is in nanoseconds of any clock; only differences count.
struct StillTimes {
  std::optional<std::int64_t> start_ns;
  std::optional<std::int64_t> exposure_ns;
};

struct ListedStill {
  std::filesystem::path file;
  std::size_t line;  // of the table, from 1 on
  StillTimes times;  // as far as the table tells
};

// Whether a file is to be read as such a table: by its extension, .csv.
[[nodiscard]] bool is_stills_table(const std::filesystem::path& path);

// The rows in their order. Throws InputError naming the line where one cannot be read, or a file is absent.
[[nodiscard]] std::vector<ListedStill> read_stills_table(const std::filesystem::path& path);

// The timing that rows tell, `exif` being what their files say, one for each. Starts come from the table for
// all files, or from EXIF data for all; the same holds for exposures, which may also be absent everywhere.
// Throws InputError naming line, file and both values where something is missing, exposures overlap, or
// the clip would be longer than 2^62 ns.
[[nodiscard]] ClipTiming timing_of(const std::filesystem::path& table, std::span<const ListedStill> stills,
                                   std::span<const StillTimes> exif);

}  // namespace nutik
