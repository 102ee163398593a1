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
class Frames {
 public:
  Frames(FrameTimes times, std::uint64_t count, FunctionSet functions, Mask mask)
      : times_(times), count_(count), functions_(std::move(functions)), mask_(std::move(mask)) {}

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] const FrameTimes& times() const { return times_; }
  [[nodiscard]] const Mask& mask() const { return mask_; }
  // Frame k's functions: its plain interval, or the functions of a file with their time 0 at its start.
  [[nodiscard]] FunctionSet functions(std::uint64_t k) const;

 private:
  FrameTimes times_;
  std::uint64_t count_;
  FunctionSet functions_;  // empty: plain intervals
  Mask mask_;
};

class FrameRequest {
 public:
  // Reads function file and mask. Throws UsageError where the options contradict each other or make no
  // sense, InputError as ExposureRequest does.
  static FrameRequest from(const Options& options);

  // The frames of a capture of this timeline and shape. Throws UsageError where there is none.
  [[nodiscard]] Frames frames(const Timeline& timeline, const Shape& shape) const;

  [[nodiscard]] const PlanOptions& plan_options() const { return plan_options_; }
  [[nodiscard]] Rational rate() const { return rate_; }
  // `24 frames a second, 180 degrees, speed 0.25`.
  [[nodiscard]] std::string text() const;

 private:
  Rational rate_;
  Rational speed_;
  Rational angle_;
  std::string from_;
  std::optional<std::string> to_;
  std::optional<ExposureRequest> functions_;
  PlanOptions plan_options_;
};

}  // namespace nutik::app
