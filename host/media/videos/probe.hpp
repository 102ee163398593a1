// What a video file says of itself, read through libavformat without decoding a picture.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "capture/rational.hpp"
#include "media/clip.hpp"
#include "media/videos/pixels.hpp"

namespace nutik::videos {

struct Probe {
  int stream = 0;  // index of the picture stream
  Shape shape;     // of the decoded pictures, before they are turned
  PixelKind pixels;
  int quarter_turns = 0;  // clockwise, until they stand upright
  ClipTiming timing;
  std::uint64_t sample_count = 0;
  std::optional<Transfer> transfer;  // where the file names one that is known here
  std::vector<Note> notes;           // what a person should know, whole sentences
};

// Reads every packet's time. Throws InputError where the file cannot be opened or has no picture
// stream.
[[nodiscard]] Probe probe(const std::filesystem::path& path, const std::optional<RawVideo>& raw);

}  // namespace nutik::videos
