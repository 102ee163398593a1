// Random stills with known codes, and the files that hold them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "capture/picture.hpp"

namespace nutik::test {

// `count` pictures of random codes 0 … white_code; 16-bit codes where white_code is above 255.
[[nodiscard]] std::vector<Picture> random_stills(Shape shape, std::uint32_t white_code, int count,
                                                 std::uint64_t seed);

// The code of a picture of 8 or 16 bits.
[[nodiscard]] std::uint32_t code_of(const Picture& picture, std::uint64_t value);

// A PGM or PPM; plain ones are text.
[[nodiscard]] std::string netpbm_file(const Picture& picture, bool plain);

// The first differing value as text, or nothing where the rasters are the same.
[[nodiscard]] std::string difference(const std::vector<std::byte>& got, const Picture& want);

// Plain TIFF files, written byte by byte as the format's own text has them: what libtiff would not
// write is in reach, and no code is shared with the reader.
struct TiffOptions {
  int bits = 16;  // a value, packed where they are no whole bytes
  bool big_endian = false;
  bool inverted = false;     // 0 is white
  bool planar = false;       // one channel behind the other
  int max_sample_value = 0;  // 0: no such tag
  int sample_format = 1;     // 1 without sign, 2 signed, 3 floating point
  int orientation = 0;       // 0: no such tag
  int extra = -1;            // what the last of the channels is, by ExtraSamples; -1: no such tag
  std::string description = {};
  bool in_one = false;  // all pages' values lie behind one another, and only the first page has a directory
  // Further tags of every page, or other values of these: type, count and value by the tag's number.
  std::map<std::uint32_t, std::array<std::uint32_t, 3>> tags = {};
};
[[nodiscard]] std::string tiff_file(const std::vector<Picture>& pages, const TiffOptions& options);

}  // namespace nutik::test
