// How far a picture may be from the exact one: known from the packed tables, before anything is launched.
//
//   in:      a plan, an arithmetic, the format that the picture will have
//   out:     for each planned function, and over all of them, the most that light may err by before it is
//            rounded to the format, and how many of the format's steps that is
//            Where no gain is below 0, single precision has a second bound, by the light itself: the dark, where
//            codes lie close together, errs by less.
//   always:  holds for every capture with these tables, whatever kind its tiles are of and however the work is
//            cut, on every device that rounds as IEEE 754 says; infinite where nothing can be promised.
//            Derived in docs/explanation/accuracy.md.
//
// A pixel that several functions share errs by its shares of what each of them may err by, and by what blending rounds.
//
// What the bound covers: weights and boundaries, their rounding to the kernel's tables, codes to light, products
// and sums, sums to light, the thresholds between codes; and 30 u₆₄ S for the reference, so that it also holds
// against a picture of the reference.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "capture/picture.hpp"
#include "render/function_course.hpp"
#include "render/output_format.hpp"
#include "render/render_plan.hpp"

namespace nutik {

struct PictureError {
  // In light, where 1 is white.
  double light = 0.0;
  // In codes for pictures of codes: how far the light may lie from its place on the scale of codes, before it
  // is rounded to one. For floating point in units of format_step().
  double steps = 0.0;
  // Light L errs by at most constant + slope · L, too, where the slope is above 0.
  LightLine line = {};

  [[nodiscard]] double of_light(double value) const {
    return line.slope > 0.0 ? std::min(light, line.constant + line.slope * std::fabs(value)) : light;
  }
};

// The reference's error, in S.
inline constexpr double kReferenceError = 30 * 0x1p-53;

struct ErrorBound {
  Precision precision = Precision::single_;
  std::vector<PictureError> functions;  // by planned function
  PictureError worst;                   // of any pixel: no smaller than each
  OutputFormat output = {};             // that it holds for
};

[[nodiscard]] ErrorBound error_bound(const RenderPlan& plan, Precision precision, const OutputFormat& output);

// That of the reference.
[[nodiscard]] ErrorBound reference_bound(const RenderPlan& plan, const OutputFormat& output);

// The bound of each pixel.
class PixelErrors {
 public:
  // The plan and its bound must live as long.
  PixelErrors(const RenderPlan& plan, const ErrorBound& bound);

  // Counted row by row.
  [[nodiscard]] PictureError of(std::uint64_t pixel) const;

 private:
  const RenderPlan& plan_;
  const ErrorBound& bound_;
  double fixed_blend_ = 0.0;  // in light
};

// What codes are off by because the thresholds between them are rounded, in light of which 1 is white.
[[nodiscard]] double threshold_error(Precision precision);

// What a step of floating point is, in S = ∫|g|/D of the function: 2^-23 for light32, the most that floats lie
// apart below S; for light64 2e-12, so that half a step is what the arithmetic in double promises.
[[nodiscard]] double format_step(const OutputFormat& output, double scale);

// What light in other primaries errs by: a channel has shares of the errors of all three, and rounds entries, products
// and sums.
[[nodiscard]] double converted_error(const ColourMatrix& matrix, double light, double scale);

// The most by which code = white · fraction_of(light) changes where light L of [0, 1] changes by constant + slope · L.
[[nodiscard]] double code_error(const Transfer& transfer, std::uint32_t white_code, const LightLine& error);

}  // namespace nutik
