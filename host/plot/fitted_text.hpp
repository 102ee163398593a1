// Text that has to fit.
#pragma once

#include <string>
#include <string_view>

#include "plot/canvas.hpp"

namespace nutik::plot {

// As much of a line's front as is no wider than `width`, with an ellipsis where something is left out.
[[nodiscard]] std::string fitted(const Canvas& canvas, std::string_view text, double width,
                                 const TextStyle& style = {});

}  // namespace nutik::plot
