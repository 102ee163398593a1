// What an exposure was asked to be: functions and mask, from files or a plain interval, and how bright.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "app/command_line/options.hpp"
#include "app/text/time_text.hpp"
#include "exposure/function_file.hpp"
#include "exposure/mask.hpp"
#include "exposure/normalization.hpp"
#include "exposure/shutter_shape.hpp"
#include "render/render_plan.hpp"

namespace nutik::app {

// The shutter of that name, and what --gain and --ev multiply light with. Throw UsageError where they are not known.
[[nodiscard]] Shutter parse_shutter(const std::string& shape, const std::optional<std::string>& error);
[[nodiscard]] double brightening(const Options& options);

class ExposureRequest {
 public:
  // Reads function file and mask. Throws UsageError where the options contradict each other, InputError
  // with all mistakes of the function file; prints its warnings.
  static ExposureRequest from(const Options& options);

  // The same for the frames of a video: no interval, or functions whose time 0 each frame says.
  static ExposureRequest for_frames(const Options& options);

  // Whether a plain interval is exposed, not the functions of a file.
  [[nodiscard]] bool is_plain() const { return !file_; }
  // When the exposure starts: the interval, or the functions' time 0. How long a plain one is.
  [[nodiscard]] const TimeText& start() const { return start_; }
  [[nodiscard]] const TimeText& length() const { return length_; }

  // The functions for a capture of this timeline, normalized, as one exposure from start() on, or from
  // another moment. Throws UsageError where a plain interval lies outside the capture or is too short for
  // its shutter, InputError where a function cannot be normalized.
  [[nodiscard]] FunctionSet functions(const Timeline& timeline) { return functions(start_, timeline); }
  [[nodiscard]] FunctionSet functions(const TimeText& start, const Timeline& timeline);

  // The same of a plain interval that is known in nanoseconds; the functions of a file have their time 0 at
  // its start, whatever its end.
  [[nodiscard]] FunctionSet functions(const Exposure& interval, const Timeline& timeline);

  // When the functions' light is gathered at the latest, counted from their time 0.
  [[nodiscard]] std::int64_t functions_end_ns() const;

  [[nodiscard]] Mask mask(const Shape& shape) const;

  [[nodiscard]] const PlanOptions& plan_options() const { return plan_options_; }
  // For naming the picture: `FnFile`, `0.4s-10ms`.
  [[nodiscard]] const std::string& label() const { return label_; }

 private:
  static ExposureRequest common(const Options& options);
  [[nodiscard]] GainFunction interval_function(const Exposure& interval, const Timeline& timeline);
  [[nodiscard]] bool mask_uses(std::uint8_t tag) const { return !mask_ || mask_pixels_[tag] > 0; }

  std::optional<FunctionFile> file_;
  std::optional<Mask> mask_;
  std::array<std::uint64_t, kMaskValues> mask_pixels_{};
  TimeText start_;
  TimeText length_;
  Shutter shutter_;
  Normalization normalization_;
  double gain_ = 1.0;
  std::string label_;
  PlanOptions plan_options_;
};

}  // namespace nutik::app
