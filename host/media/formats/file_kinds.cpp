#include "media/formats/file_kinds.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "capture/capture_mark.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/formats/extension.hpp"
#include "system/input_bytes.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

using namespace std::string_view_literals;
using inputs::kJpeg;
using inputs::kPng;

constexpr std::string_view kToPng = "make PNGs of such files: magick mogrify -format png FILES";
constexpr std::string_view kToDng = "make DNGs of them, with Adobe's DNG Converter or dnglab";
constexpr std::string_view kToTiff = "save it as a TIFF stack with the program that it comes from, or with Fiji";
constexpr std::string_view kToCamera = "save the recording as TIFF or AVI with the camera's program";
constexpr std::string_view kToVideo = "take the pictures out of it, as PNGs or as a video";
constexpr std::string_view kToEvents = "if it holds events, convert it to EVT 3.0 or DAT, with faery for one";
constexpr std::string_view kUnpack = "unpack it first";

// What stands at a file's start, where `?` is any byte, or what its name ends with.
struct RefusedKind {
  std::string_view start, extension, what, way_out;
};
constexpr RefusedKind kRefusedKinds[] = {
    {"BM????\0\0\0\0"sv, {}, "a BMP picture", kToPng},
    {"RIFF????WEBP", {}, "a WebP picture", kToPng},
    {"\0\0\0\x0CjP  "sv, {}, "a JPEG 2000 picture", kToPng},
    {"\xFF\x4F\xFF\x51", {}, "a JPEG 2000 picture", kToPng},
    {"\xFF\x0A", {}, "a JPEG XL picture", kToPng},
    {"\0\0\0\x0CJXL "sv, {}, "a JPEG XL picture", kToPng},
    {"????ftypheic", {}, "a HEIC picture", kToPng},
    {"????ftypheix", {}, "a HEIC picture", kToPng},
    {"????ftypmif1", {}, "a HEIF picture", kToPng},
    {"????ftypavif", {}, "an AVIF picture", kToPng},
    {"8BPS", {}, "a Photoshop picture", kToPng},
    {"#?RADIANCE", {}, "a Radiance HDR picture", "save it as OpenEXR, which holds all of its light"},
    {"SDPX", {}, "a DPX picture", "make PNGs of them: ffmpeg -i frame%04d.dpx -pix_fmt rgb48 frame%04d.png"},
    {"XPDS", {}, "a DPX picture", "make PNGs of them: ffmpeg -i frame%04d.dpx -pix_fmt rgb48 frame%04d.png"},
    {"\x80\x2A\x5F\xD7", {}, "a Cineon picture", kToPng},
    {"II*\0\x10\0\0\0CR"sv, {}, "a Canon CR2 picture of a sensor", kToDng},
    {"????ftypcrx ", {}, "a Canon CR3 picture of a sensor", kToDng},
    {"FUJIFILMCCD-RAW", {}, "a Fujifilm RAF picture of a sensor", kToDng},
    {{}, ".nef", "a Nikon NEF picture of a sensor", kToDng},
    {{}, ".nrw", "a Nikon NRW picture of a sensor", kToDng},
    {{}, ".arw", "a Sony ARW picture of a sensor", kToDng},
    {{}, ".orf", "an Olympus ORF picture of a sensor", kToDng},
    {{}, ".rw2", "a Panasonic RW2 picture of a sensor", kToDng},
    {{}, ".pef", "a Pentax PEF picture of a sensor", kToDng},
    {{}, ".srw", "a Samsung SRW picture of a sensor", kToDng},
    {"????RED1", {}, "a RED R3D video", "develop it with REDCINE-X, to ProRes or DPX and then PNG"},
    {"????RED2", {}, "a RED R3D video", "develop it with REDCINE-X, to ProRes or DPX and then PNG"},
    {"ARRI", {}, "an ARRIRAW picture", "develop it with ARRI's tools, to ProRes or TIFF"},
    {"\xED\xFE\0\0N\0o\0r\0p\0i\0x\0"sv, {}, "a NorPix sequence (.seq)", "export it as TIFF or AVI with StreamPix"},
    {"FFF\0"sv, {}, "a FLIR recording", kToCamera},
    {"PCO-", {}, "a PCO B16 picture", kToCamera},
    {{}, ".spe", "a Princeton Instruments SPE recording", kToCamera},
    {"ZISRAWFILE", {}, "a Zeiss CZI file", kToTiff},
    {{}, ".lif", "a Leica LIF file", kToTiff},
    {"Andor Technology", {}, "an Andor SIF file", kToTiff},
    {"DCIMG", {}, "a Hamamatsu DCIMG recording", kToTiff},
    {{}, ".mrc", "an MRC stack", kToTiff},
    {{}, ".nii", "a NIfTI volume", kToTiff},
    {{}, ".dcm", "a DICOM file", kToTiff},
    {"NRRD", {}, "an NRRD volume", kToTiff},
    {"\xDA\xCE\xBE\x0A", {}, "a Nikon ND2 file", kToTiff},
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", {}, "an OLE compound file, as microscopes write", kToTiff},
    {"Event Stream", {}, "an Event Stream recording (.es)", kToEvents},
    {"addec", {}, "a compressed ADΔER file", "save it uncompressed (raw) with adder-viz or the adder-codec-rs library"},
    {"\x89HDF\r\n\x1a\n", {}, "an HDF5 file",
     "convert events to DAT, with metavision_file_to_dat, and save pictures as a TIFF stack, with Fiji"},
    {"#!AER-DAT", {}, "an AEDAT file", "convert it to EVT or DAT with faery"},
    {"#ROSBAG", {}, "a ROS bag", kToVideo},
    {"\x89MCAP", {}, "an MCAP file of ROS", kToVideo},
    {"SQLite format 3", {}, "an SQLite database, as bags of ROS 2 are", kToVideo},
    {"MATLAB 5.0", {}, "a MATLAB file", "write its pictures as PNG or TIFF"},
    {"PK\3\4", {}, "a ZIP archive", kUnpack},
    {"\x1F\x8B", {}, "packed with gzip", kUnpack},
    {"\xFD" "7zXZ", {}, "packed with xz", kUnpack},
    {"\x28\xB5\x2F\xFD", {}, "packed with zstd", kUnpack},
    {"7z\xBC\xAF", {}, "a 7z archive", kUnpack},
    {"%PDF", {}, "a PDF document", "take the pictures out of it, with pdfimages -png for one"},
};

bool begins_with(std::string_view bytes, std::string_view start) {
  return bytes.size() >= start.size() && std::equal(start.begin(), start.end(), bytes.begin(),
                                                    [](char want, char got) { return want == '?' || want == got; });
}

// Chunks: their length, four letters, so many bytes, a checksum. acTL stands before the first picture of an animation.
bool is_png_of_several(std::string_view bytes) {
  for (std::size_t at = kPng.starts[0].size(); at + 12 <= bytes.size(); at += 12 + big_endian(bytes, at, 4)) {
    const std::string_view name = bytes.substr(at + 4, 4);
    if (name == "acTL" && at + 16 <= bytes.size() && big_endian(bytes, at + 8, 4) > 1) return true;
    if (name == "IEND") return kPng.begins(bytes.substr(at + 12));
  }
  return false;
}

// Segments: FF, a marker, and where this has data, their length; behind those of a scan comes its code, in which FF is
// followed by 0 or a marker of restarts. A camera's further pictures (MPF) are others of the same moment.
bool is_jpeg_of_several(std::string_view bytes) {
  for (std::size_t at = 2; (at = bytes.find('\xFF', at)) < bytes.size() && at + 4 <= bytes.size();) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD7)) {
      ++at;
      continue;
    }
    if (marker == 0xD9) return kJpeg.begins(bytes.substr(at + 2));
    if (marker == 0xE2 && bytes.substr(at + 4).starts_with("MPF\0"sv)) return false;
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  return false;
}

}  // namespace

std::string telling_bytes(const std::filesystem::path& file) {
  const auto is_of = [&](const inputs::InputKind* kind) { return !kind->has_front && kind->is_named(file); };
  return std::ranges::any_of(inputs::kClips, is_of) ? std::string() : first_bytes(file);
}

std::optional<std::string> unsupported_kind_text(const std::filesystem::path& file) {
  const std::string title = input_title(file.string());
  if (begins_as_capture(first_bytes(file))) {
    return format("{} is a capture (.tik) already, not a picture or a clip; pictures are exposed from it alone", title);
  }
  const std::string start = telling_bytes(file);
  for (const RefusedKind& kind : kRefusedKinds) {
    const bool is_it = kind.extension.empty() ? begins_with(start, kind.start)
                                              : !start.empty() && extension_of(file) == kind.extension;
    if (is_it) return format("{} is {}, which is not read; {}", title, kind.what, kind.way_out);
  }
  return std::nullopt;
}

void refuse_unsupported_kind(const std::filesystem::path& file) {
  if (const auto text = unsupported_kind_text(file)) throw InputError(*text);
}

void refuse_project(const std::filesystem::path& file) {
  if (extension_of(file) != kProjectExtension) return;
  throw InputError(format("{} is a project of nutik-studio, which opens it, and no clip", input_title(file.string())));
}

void refuse_text(const std::filesystem::path& file) {
  refuse_project(file);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return;
  std::array<char, 512> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view start(bytes.data(), static_cast<std::size_t>(in.gcount()));
  // These begin with letters, and their pictures may look like some.
  constexpr std::array kVideos{"YUV4MPEG2"sv, "SIMPLE  ="sv, "LUCAM-RECORDER"sv, "#EXTM3U"sv, "ffconcat"sv};
  const auto is_text = [](char c) { return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t'; };
  const bool is_video =
      begins_as_netpbm(start) || std::ranges::any_of(kVideos, [&](auto video) { return start.starts_with(video); });
  if (start.empty() || is_video || !std::ranges::all_of(start, is_text)) return;
  const std::string title = input_title(file.string());
  if (extension_of(file) == ".fn") throw InputError(format("{} is a function file, and no clip", title));
  throw InputError(format("{} is a text, and no clip; stills are listed in a .csv (file,start_ns,exposure_ns), and "
                          "events are read as EVT 3.0 or DAT",
                          title));
}

const inputs::InputKind* still_kind(const std::filesystem::path& file) {
  const std::string start = telling_bytes(file);
  // A DNG is a TIFF, and only its name or its tags say which.
  if (inputs::kTiff.begins(start)) return inputs::kDng.is_named(file) ? &inputs::kDng : &inputs::kTiff;
  for (const inputs::InputKind* kind : inputs::kStills) {
    if (kind->begins(start)) return kind;
  }
  return kind_named_by(file);
}

const inputs::InputKind* kind_named_by(const std::filesystem::path& file) {
  const auto* named = std::ranges::find_if(inputs::kStills, [&](const auto* kind) { return kind->is_named(file); });
  return named == std::end(inputs::kStills) ? nullptr : *named;
}

std::string still_kinds_text(bool inputs::InputKind::*which) {
  std::vector<std::string_view> names;
  for (const inputs::InputKind* kind : inputs::kStills) {
    if (which == nullptr || kind->*which) names.push_back(kind->name);
  }
  return joined(names);
}

std::string clip_patterns() {
  std::string text;
  for (const inputs::InputKind* kind : inputs::kClips)
    for (const std::string& extension : parts_of(kind->extensions, ' '))
      if (!extension.empty()) (text += text.empty() ? "*" : " *") += extension;
  return text;
}

bool holds_several_pictures(const std::filesystem::path& file) {
  const std::string start = first_bytes(file);
  const bool is_png = kPng.begins(start);
  if (!is_png && !kJpeg.begins(start)) return false;
  const MappedFile mapped(file);
  const std::string_view bytes = as_text(mapped.bytes());
  return is_png ? is_png_of_several(bytes) : is_jpeg_of_several(bytes);
}

}  // namespace nutik
