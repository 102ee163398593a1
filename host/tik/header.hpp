// The text at the front of a .tik: a Netpbm header whose comments say, in words a person can read, what
// the capture is.
//
//   P6
//   # TIK 1 - an image evolution model; the picture is the first sample, change records follow it.
//   # TIK size: 640 x 480
//   # TIK channels: 3
//   # TIK depth: 8 bits
//   # TIK white code: 255
//   # TIK rate: 300 samples a second
//   # TIK shutter angle: 360 degrees
//   # TIK transfer: srgb
//   # TIK pixel aspect: 1:1
//   # TIK primaries: bt709
//   # TIK tolerance: 0 codes
//   # TIK codec: rice
//   640 480
//   255
//
// Where the capture was encoded with a camera's noise, in place of the tolerance:
//
//   # TIK sigmas: 3 standard deviations
//   # TIK noise: white 255
//   # TIK noise: …            each line of the noise file (capture/noise_file.hpp)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "capture/code_roundings.hpp"
#include "capture/made_samples.hpp"
#include "capture/part_of_clip.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "tik/fields.hpp"
#include "tik/file_layout.hpp"

namespace nutik::tik {

// That each picture was moved onto one of them, so that the camera stands still.
struct Alignment {
  std::string motion;           // translation, rigid or homography
  std::uint64_t reference = 0;  // the sample that the others were moved onto
  bool holds_unseen = false;    // places that a picture did not see hold what was seen there before
  double moved_pixels = 0;      // by how far at most, of corners and the middle
  double turned_degrees = 0;
  std::optional<double> residual_pixels = {};  // half of the texture lies within this of where it should; if measured
  friend bool operator==(const Alignment&, const Alignment&) = default;
};

// The times of pictures between which samples were made, as if none had been: samples a second, or exposures.
using FilmedTimes = std::variant<Rational, std::vector<Exposure>>;
[[nodiscard]] FilmedTimes filmed_times(const Timeline& filmed);

struct Header {
  std::uint32_t version = kVersion;
  CaptureFormat capture;  // of what is held
  // Samples a second where the rate is constant; absent where every exposure is listed.
  std::optional<Rational> rate;
  Rational shutter_angle = Timeline::kFullShutter;
  std::string codec;  // a word for people; each block says what it really uses
  // Who said what of the capture: `matrix bt601, assumed`. Lines for people.
  std::vector<std::string> facts;
  std::optional<Alignment> alignment = std::nullopt;
  bool is_scaled = false;  // codes are means of the light of a clip's smaller pixels
  CodeRoundings roundings = {};  // by which codes were made of a clip
  std::optional<PartOfClip> part = std::nullopt;  // where samples are not all of a clip's pictures
  std::optional<MadeSamples> made = std::nullopt;  // where some were filmed and some made
  std::optional<FilmedTimes> filmed = std::nullopt;  // earlier programs did not say

  // The header as text, up to and including the line end before the raster.
  [[nodiscard]] std::string text() const;
  // What stands behind the picture.
  [[nodiscard]] std::vector<Field> fields() const;
};

struct ParsedHeader {
  Header header;
  std::uint64_t raster_offset = 0;       // bytes from the file's start
  std::uint64_t first_block_offset = 0;  // behind picture and fields
};

// Whether a file starts as a .tik of any version does.
[[nodiscard]] bool looks_like_tik(std::span<const std::byte> file);

// Throws InputError, beginning with `name`, where the file is no .tik, of a later version or with a field that it must
// not be read without, or its header is damaged; a Netpbm picture without TIK comments and a .tik of the original
// program are told apart from garbage.
[[nodiscard]] ParsedHeader parse_header(std::span<const std::byte> file, const std::string& name);

// Throws InputError where a field that is not known must be understood.
void refuse_unknown(std::span<const Field> fields, const std::string& name);

// Bytes of the picture at the front.
[[nodiscard]] std::uint64_t raster_bytes(const CaptureFormat& capture);

}  // namespace nutik::tik
