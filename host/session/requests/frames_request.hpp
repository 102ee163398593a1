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
#include "session/requests/film_curve.hpp"
#include "session/requests/frame_ranges.hpp"
#include "session/requests/key_frames.hpp"

namespace nutik {

struct FramesRequest {
  ExposureRequest
      exposure;            // of every frame, from the frame's start on: its own start and length say nothing
  Rational rate{24, 1};    // frames a second of playback
  Rational speed{1, 1};    // seconds of the capture for each second of playback
  Rational angle{180, 1};  // of the shutter, in degrees of a frame; not of functions
  StatedTime from;
  std::optional<StatedTime> to;        // none: the capture's end
  std::optional<FilmCurve> curve;      // in place of from, to and speed
  KeyFrames keys;                      // of functions: in place of those of the exposure; of masks likewise
  std::optional<FrameRanges> numbers;  // of the frames to make; none: all

  // `24 frames a second, 180 degrees, speed 0.25`.
  [[nodiscard]] std::string text() const;
  // When the frames are exposed in the film's own time, from 0 on.
  [[nodiscard]] FrameTimes film_times() const { return {{}, rate, {1, 1}, angle}; }

  friend bool operator==(const FramesRequest&, const FramesRequest&) = default;
};

// The frames of a video of one capture.
struct Frames {
  FrameTimes times;
  std::uint64_t count;                 // of the whole film
  std::string warning;                 // a sentence; empty where all is well
  std::vector<std::uint64_t> numbers;  // of the frames to make, in order: at least one
  std::optional<CapturedCurve> curve = {};
  std::optional<FrameTimes> film = {};  // where a curve or keys need the film's own time

  // When a frame is exposed, on the capture.
  [[nodiscard]] Exposure exposure(std::uint64_t frame) const {
    return curve ? curve->exposure(film->exposure(frame)) : times.exposure(frame);
  }
  // From the earliest to the latest time that one of the frames to make is exposed.
  [[nodiscard]] Exposure span() const;
};

// What a frame is exposed with: the request's exposure, with the functions and the mask of that moment of the film.
[[nodiscard]] ExposureRequest exposure_of(const FramesRequest& request, const Frames& frames,
                                          std::uint64_t frame);

// Throws UsageError where the capture has none, none of them is to be made, or times make no sense.
[[nodiscard]] Frames frames_of(const FramesRequest& request, const Timeline& timeline);

// Memory for a video's frames beside the renderer: those that wait, one that is converted for the encoder, and
// `encoder_frames` that the encoder keeps.
[[nodiscard]] NeedsOfFormat video_needs(std::uint32_t encoder_frames,
                                        const std::function<ValueType(const CaptureFormat&)>& type_of);

}  // namespace nutik
