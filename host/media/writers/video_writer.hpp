// Where the frames of a video go, one after another: into a container.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/picture.hpp"
#include "capture/rational.hpp"
#include "media/writers/picture_writer.hpp"

namespace nutik {

// A codec's own scale of quality: the number from best to worst, and what it is called by its encoder. None: no name.
struct CodecScale {
  std::string_view key = {};
  int best = 0, worst = 0;
  int usual = 0;  // below what an eye sees
};

// The containers and codecs that videos are written with.
struct VideoCodec {
  std::string_view name;        // as a person says it: ffv1, h264, …
  std::string_view encoder;     // as FFmpeg calls what writes it
  std::string_view containers;  // extensions, ` .mkv .avi `
  bool holds_8_bits;            // takes pictures of 8-bit codes, or else of 16 bits only
  bool holds_16_bits;
  bool is_lossless;
  std::uint32_t held_frames;  // of three values for two pixels, that its encoder keeps about
  bool pairs_pixels;          // keeps one colour for two by two pixels, so that both sides must be even
  std::string_view pixels;    // as FFmpeg calls what is encoded; empty: the frames' own
  CodecScale scale;
  std::string_view settings = {};  // of the encoder, `name=value:name=value`
};

[[nodiscard]] std::span<const VideoCodec> video_codecs();

// On the codec's scale: as it was stated itself, else between worst (1) and best (100), else what is usual. Throws
// UsageError where it has none, or a number lies outside.
[[nodiscard]] int codec_setting(const VideoCodec& codec, const std::optional<std::uint32_t>& crf,
                                const std::optional<std::uint32_t>& quality);

// A part of a clip's sound, in a film.
struct FilmSound {
  std::filesystem::path clip;
  double start_s = 0;  // of the file, where the film begins
  double speed = 1;    // seconds of the file in one of the film
  double seconds = 0;  // of the film
  bool is_cut = false;  // the film begins later than the clip
  bool is_asked = false;  // else a film without it is better than none
};

// The frames a second that a container of this name still tells apart: 1000 in .mkv and .webm, whose times are
// milliseconds, and .avi, as FFmpeg writes it; else 100000.
[[nodiscard]] double largest_rate_for(const std::filesystem::path& path);

// The codec of that name, or the one that is usual for the container: h264 in .mp4, .m4v and .mov, ffv1 in
// .mkv and .avi, vp9 in .webm. Throws UsageError listing what there is where the codec is not known or the
// container does not hold it.
[[nodiscard]] const VideoCodec& video_codec_for(const std::filesystem::path& path,
                                                const std::optional<std::string>& name);

// What all frames of a video have in common.
struct VideoFormat {
  Shape shape;
  ValueType type = ValueType::code8;
  std::uint32_t white_code = 255;  // the full range of the type, for a container
  Transfer transfer = Transfer::srgb();
  Rational rate{24, 1};  // frames a second of playback; numerator and denominator below 2^31
  Primaries primaries = Primaries::bt709;
  Rational pixel_aspect{1, 1};
  std::optional<int> codec_setting = {};  // codec_setting(); none: what is usual
  std::optional<FilmSound> sound = {};
  bool repeats_chroma = false;        // Session::repeats_chroma()
  std::filesystem::path graded = {};  // a clip in HDR whose curve it keeps, and is nowhere brighter
};

class VideoWriter {
 public:
  // Without finish(), the file that was being written is removed.
  virtual ~VideoWriter() = default;

  // The next frame, of the format that the writer was opened with. Throws OutputError.
  virtual void write(const Picture& picture) = 0;

  // Ends the video after the frames so far, and gives the file its name. Throws OutputError.
  virtual void finish() = 0;

  [[nodiscard]] virtual bool has_sound() const { return false; }

  // What a person should know of how it is written, whole sentences.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

// A video in a container: appears under its name when it is finished, and replaces what was there. Throws
// OutputError where it cannot be written or this FFmpeg lacks the encoder.
[[nodiscard]] std::unique_ptr<VideoWriter> open_video_writer(const std::filesystem::path& path,
                                                             const VideoFormat& format,
                                                             const VideoCodec& codec);

// The value type of frames for a container, as value_type_for() finds it for a picture. `usual` is the
// capture's own, which gives way to 8 bits where the codec holds no more. Throws UsageError.
[[nodiscard]] ValueType video_value_type(const VideoCodec& codec, std::optional<Depth> wish, ValueType usual);

}  // namespace nutik
