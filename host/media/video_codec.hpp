// The containers and codecs that videos are written with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "capture/picture.hpp"

namespace nutik {

struct VideoCodec {
  std::string_view name;        // as a person says it: ffv1, h264, …
  std::string_view encoder;     // as FFmpeg calls what writes it
  std::string_view containers;  // extensions, ` .mkv .avi `
  bool holds_8_bits;            // takes pictures of 8-bit codes, or else of 16 bits only
  bool holds_16_bits;
  bool is_lossless;
  std::uint32_t held_frames;  // of three values for two pixels, that its encoder keeps about
  bool pairs_pixels;          // keeps one colour for two by two pixels, so that both sides must be even
};

// The frames a second that a container of this name still tells apart: 1000 in .mkv and .webm, whose times are
// milliseconds, and .avi, as FFmpeg writes it; else 100000.
[[nodiscard]] double largest_rate_for(const std::filesystem::path& path);

// The codec of that name, or the one that is usual for the container: h264 in .mp4, .m4v and .mov, ffv1 in
// .mkv and .avi, vp9 in .webm. Throws UsageError listing what there is where the codec is not known or the
// container does not hold it.
[[nodiscard]] const VideoCodec& video_codec_for(const std::filesystem::path& path,
                                                const std::optional<std::string>& name);

}  // namespace nutik
