// What an exposure was asked to be: functions and mask, from files or a plain interval.
#pragma once

#include <optional>
#include <string>

#include "app/command_line/options.hpp"
#include "exposure/function_file.hpp"
#include "exposure/mask.hpp"
#include "render/render_plan.hpp"

namespace nutik::app {

class ExposureRequest {
 public:
  // Reads function file and mask. Throws UsageError where the options contradict each other, InputError
  // with all mistakes of the function file; prints its warnings.
  static ExposureRequest from(const Options& options);

  // The functions and the mask for a capture of this shape and timeline.
  [[nodiscard]] FunctionSet functions(const Timeline& timeline) const;
  [[nodiscard]] Mask mask(const Shape& shape) const;

  [[nodiscard]] const PlanOptions& plan_options() const { return plan_options_; }
  // For naming the picture: `FnFile`, `0.4s-10ms`.
  [[nodiscard]] const std::string& label() const { return label_; }

 private:
  std::optional<FunctionFile> file_;
  std::optional<Mask> mask_;
  std::string start_;
  std::string exposure_;
  std::string label_;
  PlanOptions plan_options_;
};

}  // namespace nutik::app
