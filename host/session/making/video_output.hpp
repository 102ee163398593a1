// Where a video goes, told from its name: a container, or a numbered still for each frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "media/writers/video_writer.hpp"
#include "session/output_check.hpp"
#include "session/requests/output_request.hpp"

namespace nutik {

class VideoOutput {
 public:
  // `rate` in frames a second; no codec: the one that is usual. Throws UsageError where the name is that of neither,
  // codec and container do not fit, or the container cannot tell so many frames a second apart.
  VideoOutput(std::filesystem::path path, Rational rate, const std::optional<std::string>& codec,
              const OutputRequest& request);

  // What values the frames have. Throws UsageError where the depth that was asked for and the file do not fit.
  [[nodiscard]] OutputFormat frame_format(const CaptureFormat& capture) const;

  // Throws UsageError where one of the files to write is an input, of another kind, or may not be replaced.
  void check(std::span<const std::uint64_t> frames, std::span<const std::string> inputs,
             Replacing replacing) const;
  // The still of a frame. Of stills alone.
  [[nodiscard]] std::filesystem::path still(std::uint64_t frame) const;

  [[nodiscard]] std::unique_ptr<VideoWriter> open(const CaptureFormat& capture,
                                                  const OutputFormat& format) const;

  // That the encoder keeps.
  [[nodiscard]] std::uint32_t encoder_frames() const { return codec_ == nullptr ? 1 : codec_->held_frames; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool writes_stills() const { return codec_ == nullptr; }
  // `h264`, or `stills`.
  [[nodiscard]] std::string kind() const;

 private:
  std::filesystem::path path_;
  Rational rate_;
  OutputRequest request_;
  const VideoCodec* codec_ = nullptr;  // null: stills
};

}  // namespace nutik
