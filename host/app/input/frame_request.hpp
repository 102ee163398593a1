// What a video was asked to be: when its frames are exposed, and with what.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/command_line/options.hpp"
#include "app/input/exposure_request.hpp"
#include "capture/frame_times.hpp"

namespace nutik::app {

// The frames of a video of one capture.
struct Frames {
  FrameTimes times;
  std::uint64_t count;
};

class FrameRequest {
 public:
  // Reads function file and mask. Throws UsageError where the options contradict each other or make no
  // sense, InputError as ExposureRequest does.
  static FrameRequest from(const Options& options);

  // When the frames of a capture are exposed. Throws UsageError where there is none.
  [[nodiscard]] Frames frames(const Timeline& timeline) const;

  // What is exposed in each: functions for the interval that is a frame's, and the mask.
  [[nodiscard]] ExposureRequest& exposure() { return exposure_; }
  [[nodiscard]] const PlanOptions& plan_options() const { return exposure_.plan_options(); }

  [[nodiscard]] Rational rate() const { return rate_; }
  // `24 frames a second, 180 degrees, speed 0.25`.
  [[nodiscard]] std::string text() const;

 private:
  FrameRequest(const Options& options, ExposureRequest exposure);

  ExposureRequest exposure_;
  Rational rate_;
  Rational speed_;
  Rational angle_;
  std::string from_;
  std::optional<std::string> to_;
};

}  // namespace nutik::app
