// When a video's pictures are shown, from what its container says of its packets; where that does not do, of pictures
// that were decoded.
//
//   in:      packets in the order of decoding, with their times in ticks of the stream's clock
//   out:     a constant rate where all times are those of one, else each picture's time
//   always:  a rate is taken only where no picture is half a period from its place
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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
  bool is_key = false;  // refers to no other picture
};

// How many packets at the start refer to pictures that the file lacks, for it was cut in its middle; 0 where no packet
// is a key picture's.
[[nodiscard]] std::size_t packets_before_key(const std::vector<PacketTimes>& packets);

// Whether packets do not tell when which pictures are shown: some lack the time, or pictures are shown before the first
// one, to which they refer as to one before it, which may be missing.
[[nodiscard]] bool must_be_decoded(const std::vector<PacketTimes>& packets);

// A rate that may be that of a file's pictures.
struct KnownRate {
  Rational rate;
  // By the container, on its own: its times may be rounded to a clock that is coarser than half a period. Else it is
  // the mean of the times, or guessed from them.
  bool is_stated = false;
};

// Pictures lie at `times`, in order, in units of `time_base` seconds: the first of the rates that fits them, or else
// the times themselves. Throws InputError where they lie more than 146 years apart.
[[nodiscard]] ClipTiming timing_of(const std::vector<std::int64_t>& times, Rational time_base,
                                   std::vector<KnownRate> rates, const std::string& name);

// When the pictures of these packets are shown, in order; none where the container does not tell. `delay`: how many
// pictures the decoder holds back.
[[nodiscard]] std::vector<std::int64_t> shown_times(const std::vector<PacketTimes>& packets, int delay);

// The timing of a stream's pictures, which are shown at `times`: none where nothing tells.
[[nodiscard]] ClipTiming timing_of(const AVFormatContext& file, const AVStream& stream,
                                   const std::vector<std::int64_t>& times, const std::string& name);

// Why no rate of a stream is taken, although FFmpeg tells one: empty where that is its own. None where the file states
// it.
[[nodiscard]] std::optional<std::string> doubt_about_rate(const AVFormatContext& file, const AVStream& stream,
                                                          std::span<const std::byte> bytes);

// The rates that a stream announces, the surest first.
[[nodiscard]] std::vector<KnownRate> announced_rates(const AVFormatContext& file, const AVStream& stream);

}  // namespace nutik::videos
