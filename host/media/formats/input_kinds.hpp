// Kinds of input: what each is recognized by, where its times and codes come from, how it is read, and written. A kind
// has a row, which stands with what reads it, and is named here, once below and in the list that it belongs to.
// docs/reference/input.md has a table of them, which a test compares. What is refused by name stands in file_kinds.cpp,
// and of FFmpeg's containers in videos/containers.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "media/formats/extension.hpp"
#include "media/formats/picture_format.hpp"

namespace nutik {
class Clip;
struct ClipInfo;
struct ClipOptions;
}  // namespace nutik

namespace nutik::inputs {

using Bytes = std::span<const std::byte>;
using Files = std::vector<std::filesystem::path>;

struct InputKind {
  std::string_view name;
  std::array<std::string_view, 5> starts = {};  // a file of this kind begins with one of them
  std::string_view extensions = {};             // or its name ends with one of them, each between blanks
  std::string_view otherwise = {};              // or this is so, in words
  // What the page says; `none`: nothing in such files tells it.
  struct Said {
    std::string_view times;        // where rate and times of the pictures come from
    std::string_view shutter;      // where their exposure comes from
    std::string_view codes;        // what codes are kept, and which are black and white
    std::string_view orientation;  // what turns pictures upright
    std::string_view alpha;        // what becomes of transparency
    std::string_view order;        // in which order pictures are read
  } said;
  std::string_view behind_start = {};  // one of these characters follows the first bytes; empty: any
  bool has_front = true;               // without one, pixels may begin as any other file does: its name goes first

  // What a file of a picture has.
  bool has_tags = false;  // whole numbers in it may be a mask's, besides those in a PNG and a PGM
  // Null where the module for stills has a reader of its own for it. Throws InputError naming `name`.
  FilePicture (*read)(Bytes file, const std::string& name, std::size_t place) = nullptr;
  std::vector<std::size_t> (*places)(Bytes file, const std::string& name) = nullptr;  // of pictures; null: there is one
  // The line that it carries (stills/picture_text.hpp). Null where it has no place for one.
  std::optional<std::string> (*text)(Bytes file, const std::filesystem::path& path) = nullptr;
  WrittenFormat written[3] = {};

  // What a name stands for if it is a clip of this kind; null where that is the file itself, which begins so.
  // Throws InputError if that is damaged or not all there.
  std::optional<Files> (*files)(const std::filesystem::path& path) = nullptr;
  std::unique_ptr<Clip> (*open)(const std::filesystem::path& path, const Files& files,
                                const ClipOptions& options) = nullptr;
  // Adds what there is to tell besides what its module knows.
  void (*describe)(ClipInfo& info, const std::filesystem::path& path, const Files& files) = nullptr;
  bool has_events = false;

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

extern const InputKind kVideo, kRawVideo, kPng, kJpeg, kTiff, kNetpbm, kExr, kPfm, kNumpy, kSequence, kTable, kPhotron,
    kProphesee, kAdder;

inline constexpr InputKind kDng{
    "DNG", {}, " .dng ", "a TIFF's `DNGVersion`",
    {"the first one's `FrameRate`; EXIF, in a table", "`ExposureTime`, if alike; EXIF, in a table",
     "developed by the first one's black, white and colours: RGB over 16 bits, linear", "`Orientation`", "none",
     "one picture"}};
inline constexpr InputKind kPhantom{
    "Phantom", {"CI"}, {}, {},
    {"the camera's times, else its nominal rate", "its exposures, if alike, else its shutter time",
     "as of a video; packed 10 bits by the format's table, linear, white 4095; black stays, with a note",
     "`bFlipV`", "none", "as stored"}};
inline constexpr InputKind kCapture{
    "capture (no clip)", {}, {}, "first bytes", {"its own", "its own", "its own", "upright", "none", "by time"}};

// Pictures of one file each, of which sequences are made.
inline constexpr const InputKind* kStills[] = {&kPng, &kJpeg, &kTiff, &kDng, &kNetpbm, &kExr, &kPfm, &kNumpy};
// Those that are written, in the order in which messages name their extensions.
inline constexpr const InputKind* kWritten[] = {&kPng, &kTiff, &kJpeg, &kExr, &kNetpbm, &kPfm, &kNumpy};
// The first that takes a name has it; what nothing takes is perhaps a video.
inline constexpr const InputKind* kClips[] = {&kPhotron, &kProphesee, &kAdder, &kTable, &kSequence};

}  // namespace nutik::inputs
