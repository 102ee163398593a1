// What each kind of input is recognized by, and where its times and codes come from. docs/reference/input.md has the
// same table, which a test compares. What is refused by name stands in file_kinds.cpp, and of FFmpeg's containers in
// videos/containers.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "media/formats/extension.hpp"

namespace nutik::inputs {

struct InputKind {
  std::string_view name;
  std::array<std::string_view, 5> starts;  // a file of this kind begins with one of them
  std::string_view extensions;             // or its name ends with one of them, each between blanks
  std::string_view otherwise;              // or this is so, in words
  // What the page says; `none`: nothing in such files tells it.
  std::string_view times;              // where rate and times of the pictures come from
  std::string_view shutter;            // where their exposure comes from
  std::string_view codes;              // what codes are kept, and which are black and white
  std::string_view orientation;        // what turns pictures upright
  std::string_view alpha;              // what becomes of transparency
  std::string_view order;              // in which order pictures are read
  std::string_view behind_start = {};  // one of these characters follows the first bytes; empty: any
  bool has_tags = false;               // whole numbers in it may be a mask's, besides those in a PNG and a PGM

  [[nodiscard]] constexpr bool begins(std::string_view bytes) const {
    for (const std::string_view start : starts) {
      if (start.empty() || !bytes.starts_with(start)) continue;
      const std::string_view next = bytes.substr(start.size(), 1);
      if (behind_start.empty() || (!next.empty() && behind_start.find(next) != next.npos)) return true;
    }
    return false;
  }
  // Modules have rows of their own, whose addresses differ.
  [[nodiscard]] friend constexpr bool operator==(const InputKind& a, const InputKind& b) { return a.name == b.name; }
  [[nodiscard]] bool is_named(const std::filesystem::path& file) const {
    const std::string extension = extension_of(file);
    return !extension.empty() && extensions.find(" " + extension + " ") != std::string_view::npos;
  }
};

using std::literals::operator""sv;

inline constexpr InputKind kVideo{
    "video", {}, {}, "what FFmpeg takes it for", "its pictures' times; filming rates of Android, Samsung and Sony",
    "none", "colour: RGB of 8 bits, or over 16, by matrix and range; grey: as stored, white by its bits; or by range",
    "display matrix, by quarter turns", "left out, with a note", "as shown"};
inline constexpr InputKind kRawVideo{
    "raw video", {}, {}, "your description", "Photron's header beside it", "that header", "as of a video", "none",
    "left out, with a note", "as stored"};
inline constexpr InputKind kPng{
    "PNG", {"\x89PNG\r\n\x1a\n"}, " .png ", {}, "none", "none", "as stored, white 255, or 65535 with a note",
    "EXIF", "refused", "one picture"};
inline constexpr InputKind kJpeg{
    "JPEG", {"\xFF\xD8\xFF"}, " .jpg .jpeg ", {}, "EXIF, in a table", "EXIF, in a table", "as stored, white 255",
    "EXIF", "none", "one picture"};
inline constexpr InputKind kTiff{
    "TIFF", {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}, " .tif .tiff ", {}, "ImageJ's or OME's description", "none",
    "as stored, white by its bits; of 16 `MaxSampleValue` if all ones, else 65535 with a note; floats as of OpenEXR",
    "`Orientation`", "refused", "its pages", {}, true};
inline constexpr InputKind kDng{
    "DNG", {}, " .dng ", "a TIFF's `DNGVersion`", "the first one's `FrameRate`; EXIF, in a table",
    "`ExposureTime`, if alike; EXIF, in a table",
    "developed by the first one's black, white and colours: RGB over 16 bits, linear", "`Orientation`", "none",
    "one picture"};
inline constexpr InputKind kNetpbm{
    "Netpbm", {"P2", "P3", "P5", "P6", "P7"}, " .pgm .ppm .pnm .pam ", {}, "none", "none",
    "as stored, white is its maximum", "none", "none", "one behind the other", " \t\r\n"};
inline constexpr InputKind kExr{
    "OpenEXR", {"\x76\x2F\x31\x01"}, " .exr ", {}, "none", "none",
    "floating-point light, over 16 bits by the white that you state", "as it lies", "refused", "one picture", {}, true};
inline constexpr InputKind kPfm{
    "PFM", {"PF", "Pf"}, " .pfm ", {}, "none", "none", "as of OpenEXR", "none", "none", "one picture", " \t\r\n",
    true};
inline constexpr InputKind kNumpy{
    "NumPy", {"\x93NUMPY"}, " .npy ", {}, "none", "none",
    "integers as stored, white 255 or 65535; floats as of OpenEXR", "none", "none",
    "its first axis, if it has three, or four with colour", {}, true};
inline constexpr InputKind kSequence{
    "several stills", {}, {}, "a folder, `'frames/*.png'`, `frame%04d.tif`",
    "the first one's, else a folder's only Photron header", "as the times", "alike in all", "each one's",
    "as of one", "as a person counts, 2 before 10"};
inline constexpr InputKind kTable{
    "table of stills", {}, " .csv ", {}, "its column, else EXIF", "its column, else EXIF", "alike in all", "each one's",
    "as of one", "its rows"};
// Pixels without a header in front may begin as any other file does: its name goes before all bytes.
inline constexpr InputKind kPhotron{
    "Photron", {}, " .mraw .cih .cihx ", {}, "the header", "the header",
    "as stored, linear, white by the header's bits", "none", "none", "as stored"};
inline constexpr InputKind kPhantom{
    "Phantom", {"CI"}, {}, {}, "the camera's times, else its nominal rate",
    "its exposures, if alike, else its shutter time",
    "as of a video; packed 10 bits by the format's table, linear, white 4095; black stays, with a note",
    "`bFlipV`", "none", "as stored"};
inline constexpr InputKind kProphesee{
    "Prophesee", {"% "}, {}, {}, "each event's", "until the next moment", "light from steps: 16 bits, linear", "none",
    "none", "by time"};
inline constexpr InputKind kAdder{
    "ADΔER", {"adder"}, {}, {}, "each event's", "until the next moment",
    "light as told: 16 bits, linear, white by its source", "none", "none", "by time"};
inline constexpr InputKind kCapture{
    "capture (no clip)", {}, {}, "first bytes", "its own", "its own", "its own", "upright", "none", "by time"};

// Pictures of one file each, of which sequences are made.
inline constexpr const InputKind* kStills[] = {&kPng, &kJpeg, &kTiff, &kDng, &kNetpbm, &kExr, &kPfm, &kNumpy};
inline constexpr const InputKind* kAll[] = {&kVideo,  &kRawVideo, &kPng,   &kJpeg,     &kTiff,  &kDng,
                                         &kNetpbm, &kExr,      &kPfm,   &kNumpy,    &kSequence, &kTable,
                                         &kPhotron, &kPhantom, &kProphesee, &kAdder, &kCapture};

}  // namespace nutik::inputs
