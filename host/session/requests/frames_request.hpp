// A video, as it is asked for: when its frames are exposed, and how.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "capture/frame_times.hpp"
#include "capture/rational.hpp"
#include "session/memory_budget.hpp"
#include "session/requests/exposure_request.hpp"

namespace nutik {

struct FramesRequest {
  ExposureRequest
      exposure;            // of every frame, from the frame's start on: its own start and length say nothing
  Rational rate{24, 1};    // frames a second of playback
  Rational speed{1, 1};    // seconds of the capture for each second of playback
  Rational angle{180, 1};  // of the shutter, in degrees of a frame; not of functions
  StatedTime from;
  std::optional<StatedTime> to;  // none: the capture's end

  // `24 frames a second, 180 degrees, speed 0.25`.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const FramesRequest&, const FramesRequest&) = default;
};

// The frames of a video of one capture.
struct Frames {
  FrameTimes times;
  std::uint64_t count;
  std::string warning;  // a sentence; empty where all is well
};

// Throws UsageError where the capture has none, or times make no sense.
[[nodiscard]] Frames frames_of(const FramesRequest& request, const Timeline& timeline);

// Memory for a video's frames beside the renderer: those that wait, one that is converted for the encoder, and
// `encoder_frames` that the encoder keeps.
[[nodiscard]] NeedsOfFormat video_needs(std::uint32_t encoder_frames,
                                        const std::function<ValueType(const CaptureFormat&)>& type_of);

}  // namespace nutik
