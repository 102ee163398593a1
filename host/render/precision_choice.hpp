// `auto`: the fastest arithmetic that is right enough for the picture asked for.
//
//   in:      a plan, the format of the picture, what the device can do
//   out:     an arithmetic, its bound, and those that were faster but not sure enough
//   always:  known before a sample is read, and the same on every device that has the same arithmetics
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/error_bound.hpp"

namespace nutik {

// The largest error that a picture is given, in steps of its format (PictureError::steps).
inline constexpr double kMaxSteps = 0.5;

struct PrecisionChoice {
  ErrorBound bound;                  // of the arithmetic that was chosen
  std::vector<ErrorBound> rejected;  // faster ones that may err by more than kMaxSteps

  [[nodiscard]] Precision precision() const { return bound.precision; }
  [[nodiscard]] bool is_right_enough() const { return bound.worst.steps <= kMaxSteps; }
};

// The first of `available` (fastest first, not empty) whose bound keeps the format within kMaxSteps; where none
// does, the one with the least bound.
[[nodiscard]] PrecisionChoice choose_precision(const RenderPlan& plan, const OutputFormat& output,
                                               std::span<const Precision> available);

// `light within 3.1e-07, 0.01 of an 8-bit code`
[[nodiscard]] std::string error_text(const PictureError& error, const OutputFormat& output);

}  // namespace nutik
