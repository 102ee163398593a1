// What a render did and took, for a person.
#pragma once

#include <string>

#include "render/renderer.hpp"

namespace nutik {

// Two lines: blocks, times and memory; the arithmetic, its bound, and those of arithmetics that were not taken.
// Empty of the reference, which measures nothing.
[[nodiscard]] std::string rendering_report(const Rendered& rendered, const OutputFormat& output);

}  // namespace nutik
