// How a picture of a sweep is exposed on its own.
//
//   in:      the functions that it was exposed with, and what was varied
//   out:     what says the same without the sweep
//   always:  expose makes the same functions from it, to the last bit; where that cannot be, there is none
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "capture/timeline.hpp"
#include "media/writers/recipe.hpp"
#include "render/render_plan.hpp"
#include "session/requests/exposure_request.hpp"

namespace nutik {

// A plain interval of the sweep's shutter, divided by the time with a gain.
struct OwnInterval {
  StatedTime start, length;
  double gain = 1.0;  // that light is multiplied with
};

// An interval where that makes the functions, else the text of a function file: its functions are neither normalized
// nor brightened again.
using OwnExposure = std::variant<OwnInterval, Recipe::Text>;

// The text has the name `functions_name`. None for an interval outside the capture, which expose refuses, and where
// functions jump that no interval makes, for a function file has no jumps.
[[nodiscard]] std::optional<OwnExposure> own_exposure(const FunctionSet& functions,
                                                      const ExposureRequest& request,
                                                      const Timeline& timeline,
                                                      const std::string& functions_name);

}  // namespace nutik
