// When a video's pictures are shown, from what its container says of its packets, without decoding a picture.
//
//   in:      packets in the order of decoding, with their times in ticks of the stream's clock
//   out:     a constant rate where all times are those of one, else each picture's time
//   always:  a rate is taken only where no picture is half a period from its place
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "media/clip.hpp"
#include "media/videos/libav.hpp"

namespace nutik::videos {

// AV_NOPTS_VALUE where the container does not say.
struct PacketTimes {
  std::int64_t shown = AV_NOPTS_VALUE;    // pts
  std::int64_t decoded = AV_NOPTS_VALUE;  // dts
  std::int64_t duration = 0;
};

// A rate that may be that of a file's pictures.
struct KnownRate {
  Rational rate;
  // By the container, on its own: its times may be rounded to a clock that is coarser than half a period. Else it is
  // the mean of the times, or guessed from them.
  bool is_stated = false;
};

// Of pictures at `times`, in order, in units of `time_base` seconds: the first of the rates that fits them, or else the
// times themselves. Throws InputError where they lie more than 146 years apart.
[[nodiscard]] ClipTiming timing_of(const std::vector<std::int64_t>& times, Rational time_base,
                                   std::vector<KnownRate> rates, const std::string& name);

// Of the pictures of a stream.
[[nodiscard]] ClipTiming timing_of(const AVFormatContext& file, const AVStream& stream,
                                   const std::vector<PacketTimes>& packets, const std::string& name);

// The rates that a stream announces, the surest first.
[[nodiscard]] std::vector<KnownRate> announced_rates(const AVFormatContext& file, const AVStream& stream);

}  // namespace nutik::videos
