// What Vision Research's .cine files (Phantom cameras) tell of their pictures and FFmpeg does not hand on, and what
// they make of 12-bit light in 10 bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "media/videos/libav.hpp"

namespace nutik::videos {

struct CineHeader {
  std::vector<std::int64_t> starts_ns;     // of each picture, by the camera's clock; the first is 0
  std::optional<std::int64_t> exposed_ns;  // of each picture, where all were exposed alike
  bool is_packed_12 = false;               // two pixels in three bytes
  std::uint32_t black_code = 0;            // the code of a picture without light
};

// Empty where the file is no .cine. Lists are empty where the file holds none, or not one for each
// picture.
[[nodiscard]] std::optional<CineHeader> read_cine_header(const std::filesystem::path& path);

// Files whose compression is 256 hold four codes of 10 bits in five bytes, the highest bit first. The camera compands:
// dark codes lie one value of 12 bits apart, bright ones eight. Their way back is a table of the format, the same for
// all cameras.
inline constexpr std::uint32_t kPhantomPackedBits = 10;  // of a code in the file
inline constexpr std::uint32_t kPhantomBits = 12;        // of what the table gives

// Whether FFmpeg unpacks the stream's pictures from 10 bits.
[[nodiscard]] bool is_phantom_packed(const AVCodecParameters& codec);

// Puts for each code of a decoded picture, which FFmpeg moved up to fill 16 bits, what it stands for, moved up as well.
// Empty low bits repeat the high ones, so that white fills all bits.
void expand_phantom_codes(AVFrame& frame);

}  // namespace nutik::videos
