// What a video file says of itself, read through libavformat; pictures are decoded only where packets do not tell when
// they are shown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "capture/rational.hpp"
#include "media/clip.hpp"
#include "media/videos/picture_decoder.hpp"
#include "media/videos/pixels.hpp"

namespace nutik::videos {

struct Probe {
  int stream = 0;  // index of the picture stream
  Shape shape;     // of the decoded pictures, before they are turned
  PixelKind pixels;
  AVPixelFormat pixel_format = AV_PIX_FMT_NONE;
  Upright upright;
  std::optional<YuvMatrix> matrix;  // as the file names them
  std::string unread_matrix;        // that it names, and by which nothing here makes RGB
  std::string matrix_filter;        // of FFmpeg, that makes another of it; empty: none is known
  std::optional<CodeRange> range;
  std::optional<ChromaPlace> chroma_at;
  std::optional<Primaries> primaries;
  std::string near_primaries;            // that the file names and that count as these; empty: it names these
  std::optional<Rational> pixel_aspect;  // of pictures that stand upright
  std::string transfer_name;  // that the file has for its function, known here or not; empty: it has none
  ClipTiming timing;
  std::uint64_t sample_count = 0;
  std::optional<ClipSound> sound;
  PictureDecoder::Packets packets;
  std::optional<Transfer> transfer;   // where the file names one that is known here
  std::string curve_from = "the file";  // what names it, and the primaries
  std::vector<Note> notes;            // what a person should know, whole sentences
};

// Reads every packet's time. Throws InputError where the file cannot be opened or has no picture
// stream.
[[nodiscard]] Probe probe(const std::filesystem::path& path, const std::optional<RawVideo>& raw);

}  // namespace nutik::videos
