// What is believed of each kind of input: a row for each, by which files are recognized, and which says where the rest
// comes from. docs/reference/input.md has the same table, which a test compares. What is refused by name stands in
// file_kinds.cpp, and of FFmpeg's containers in videos/containers.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "media/formats/extension.hpp"

namespace nutik::readers {

struct Reader {
  std::string_view name;
  // First bytes; ends of names, each between blanks; what else, for people: one of them recognizes a file.
  std::array<std::string_view, 5> starts;
  std::string_view extensions, otherwise;
  // For people. `none`: nothing in such files tells it.
  std::string_view times, shutter, codes, orientation, alpha, order;
  std::string_view behind_start = {};  // one of these characters follows it; empty: whatever

  [[nodiscard]] constexpr bool begins(std::string_view bytes) const {
    for (const std::string_view start : starts) {
      if (start.empty() || !bytes.starts_with(start)) continue;
      const std::string_view next = bytes.substr(start.size(), 1);
      if (behind_start.empty() || (!next.empty() && behind_start.find(next) != next.npos)) return true;
    }
    return false;
  }
  // Modules have rows of their own, whose addresses differ.
  [[nodiscard]] friend constexpr bool operator==(const Reader& a, const Reader& b) { return a.name == b.name; }
  [[nodiscard]] bool is_named(const std::filesystem::path& file) const {
    const std::string extension = extension_of(file);
    return !extension.empty() && extensions.find(" " + extension + " ") != std::string_view::npos;
  }
};

using std::literals::operator""sv;

inline constexpr Reader kVideo{
    "video", {}, {}, "what FFmpeg takes it for", "its pictures' times; filming rates of Android, Samsung and Sony", "none",
    "colour: RGB of 8 bits, or over 16, by matrix and range; grey: as stored, white by its bits; or by range",
    "display matrix, by quarter turns", "left out, with a note", "as shown"};
inline constexpr Reader kRawVideo{
    "raw video", {}, {}, "your description", "Photron's header beside it", "that header", "as of a video", "none",
    "left out, with a note", "as stored"};
inline constexpr Reader kPng{
    "PNG", {"\x89PNG\r\n\x1a\n"}, " .png ", {}, "none", "none", "as stored, white 255, or 65535 with a note",
    "EXIF", "refused", "one picture"};
inline constexpr Reader kJpeg{
    "JPEG", {"\xFF\xD8\xFF"}, " .jpg .jpeg ", {}, "EXIF, in a table", "EXIF, in a table", "as stored, white 255",
    "EXIF", "none", "one picture"};
inline constexpr Reader kTiff{
    "TIFF", {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}, " .tif .tiff ", {}, "ImageJ's or OME's description", "none",
    "as stored, white by its bits; of 16 `MaxSampleValue` if all ones, else 65535 with a note; floats as of OpenEXR",
    "`Orientation`", "refused", "its pages"};
inline constexpr Reader kDng{
    "DNG", {}, " .dng ", "a TIFF's `DNGVersion`", "the first one's `FrameRate`; EXIF, in a table", "`ExposureTime`, if alike; EXIF, in a table",
    "developed by the first one's black, white and colours: RGB over 16 bits, linear", "`Orientation`", "none", "one picture"};
inline constexpr Reader kNetpbm{
    "Netpbm", {"P2", "P3", "P5", "P6", "P7"}, " .pgm .ppm .pnm .pam ", {}, "none", "none",
    "as stored, white is its maximum", "none", "none", "one behind the other", " \t\r\n"};
inline constexpr Reader kExr{
    "OpenEXR", {"\x76\x2F\x31\x01"}, " .exr ", {}, "none", "none",
    "floating-point light, over 16 bits by the white that you state", "as it lies", "refused", "one picture"};
inline constexpr Reader kPfm{
    "PFM", {"PF", "Pf"}, " .pfm ", {}, "none", "none", "as of OpenEXR", "none", "none", "one picture", " \t\r\n"};
inline constexpr Reader kNumpy{
    "NumPy", {"\x93NUMPY"}, " .npy ", {}, "none", "none",
    "integers as stored, white 255 or 65535; floats as of OpenEXR", "none", "none", "its first axis, if it has three, or four with colour"};
inline constexpr Reader kSequence{
    "several stills", {}, {}, "a folder, `'frames/*.png'`, `frame%04d.tif`", "the first one's, else a folder's only Photron header",
    "as the times", "alike in all", "each one's", "as of one", "as a person counts, 2 before 10"};
inline constexpr Reader kTable{
    "table of stills", {}, " .csv ", {}, "its column, else EXIF", "its column, else EXIF", "alike in all", "each one's",
    "as of one", "its rows"};
// Pixels without a header in front may begin as any other file does: its name goes before all bytes.
inline constexpr Reader kPhotron{
    "Photron", {}, " .mraw .cih .cihx ", {}, "the header", "the header",
    "as stored, linear, white by the header's bits", "none", "none", "as stored"};
inline constexpr Reader kPhantom{
    "Phantom", {"CI"}, {}, {}, "the camera's times, else its nominal rate", "its exposures, if alike, else its shutter time",
    "as of a video; packed 10 bits by the format's table, linear, white 4095; black stays, with a note",
    "`bFlipV`", "none", "as stored"};
inline constexpr Reader kProphesee{
    "Prophesee", {"% "}, {}, {}, "each event's", "until the next moment", "light from steps: 16 bits, linear", "none", "none",
    "by time"};
inline constexpr Reader kAdder{
    "ADΔER", {"adder"}, {}, {}, "each event's", "until the next moment", "light as told: 16 bits, linear, white by its source",
    "none", "none", "by time"};
inline constexpr Reader kCapture{
    "capture (no clip)", {}, {}, "first bytes", "its own", "its own", "its own", "upright", "none", "by time"};

// Pictures of one file each, of which sequences are made.
inline constexpr const Reader* kStills[] = {&kPng, &kJpeg, &kTiff, &kDng, &kNetpbm, &kExr, &kPfm, &kNumpy};
inline constexpr const Reader* kAll[] = {&kVideo,  &kRawVideo, &kPng,   &kJpeg,     &kTiff,  &kDng,
                                         &kNetpbm, &kExr,      &kPfm,   &kNumpy,    &kSequence, &kTable,
                                         &kPhotron, &kPhantom, &kProphesee, &kAdder, &kCapture};

}  // namespace nutik::readers
