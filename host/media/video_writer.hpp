// Where the frames of a video go, one after another: into a container, or into numbered stills.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "capture/rational.hpp"
#include "media/picture_writer.hpp"
#include "media/video_codec.hpp"

namespace nutik {

// What all frames of a video have in common.
struct VideoFormat {
  Shape shape;
  ValueType type = ValueType::code8;
  std::uint32_t white_code = 255;  // the full range of the type, for a container
  Transfer transfer = Transfer::srgb();
  Rational rate{24, 1};  // frames a second of playback; numerator and denominator below 2^31
  Primaries primaries = Primaries::bt709;
  Rational pixel_aspect{1, 1};
};

class VideoWriter {
 public:
  // Without finish(), the file that was being written is removed.
  virtual ~VideoWriter() = default;

  // The next frame, of the format that the writer was opened with. Where frames are files of their own they keep
  // `text` as write_picture() does, and have `number` in their names. Throws OutputError.
  virtual void write(const Picture& picture, const std::string& text, std::uint64_t number) = 0;
  void write(const Picture& picture, std::uint64_t number = 0) { write(picture, {}, number); }

  // Ends the video after the frames so far, and gives the file its name. Throws OutputError.
  virtual void finish() = 0;

  // What a person should know of how it is written, whole sentences.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

// A video in a container: appears under its name when it is finished, and replaces what was there. Throws
// OutputError where it cannot be written or this FFmpeg lacks the encoder.
[[nodiscard]] std::unique_ptr<VideoWriter> open_video_writer(const std::filesystem::path& path,
                                                             const VideoFormat& format,
                                                             const VideoCodec& codec);

// A still for each frame, `frame-%05d.png`: each appears when it is whole, and stays.
[[nodiscard]] std::unique_ptr<VideoWriter> open_still_writer(const std::filesystem::path& path,
                                                             const FileWishes& wishes = {});

// The value type of frames for a container, as value_type_for() finds it for a picture. `usual` is the
// capture's own, which gives way to 8 bits where the codec holds no more. Throws UsageError.
[[nodiscard]] ValueType video_value_type(const VideoCodec& codec, std::optional<Depth> wish, ValueType usual);

}  // namespace nutik
