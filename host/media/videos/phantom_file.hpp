// What Vision Research's cameras (Phantom) make of 12-bit light in 10 bits, and the way back.
//
// Files whose compression is 256 hold four codes of 10 bits in five bytes, the highest bit first. The camera compands:
// dark codes lie one value of 12 bits apart, bright ones eight. Their way back is a table of the format, the same for
// all cameras.
#pragma once

#include <array>
#include <cstdint>

#include "media/videos/libav.hpp"

namespace nutik::videos {

inline constexpr std::uint32_t kPhantomPackedBits = 10;  // of a code in the file
inline constexpr std::uint32_t kPhantomBits = 12;        // of what the table gives

// What each code of 10 bits stands for: values of 12 bits, proportional to light but for black, which is 64.
extern const std::array<std::uint16_t, 1024> kPhantomLight;

// Whether FFmpeg unpacks the stream's pictures from 10 bits.
[[nodiscard]] bool is_phantom_packed(const AVCodecParameters& codec);

// Puts for each code of a decoded picture, which FFmpeg moved up to fill 16 bits, what it stands for, moved up as well.
// Empty low bits repeat the high ones, so that white fills all bits.
void expand_phantom_codes(AVFrame& frame);

}  // namespace nutik::videos
