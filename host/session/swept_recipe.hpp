// How a picture of a sweep is exposed on its own.
//
//   in:      the functions that it was exposed with, and what was varied
//   out:     what its recipe states in place of the sweep's options
//   always:  expose makes the same functions from it, to the last bit; where that cannot be, there is none
#pragma once

#include <optional>
#include <string>

#include "capture/timeline.hpp"
#include "render/render_plan.hpp"
#include "session/exposure_request.hpp"
#include "session/picture_recipe.hpp"

namespace nutik {

// A plain interval of the sweep's shutter where that makes the functions, else their text under the name
// `functions_name`. None for an interval outside the capture, which expose refuses, and where functions jump that
// no interval makes, for a function file has no jumps.
[[nodiscard]] std::optional<OwnRecipe> swept_recipe(const FunctionSet& functions,
                                                    const ExposureRequest& request, const Timeline& timeline,
                                                    const std::string& functions_name);

}  // namespace nutik
