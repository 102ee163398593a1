// How far a picture is from the reference's, and whether that is within what its arithmetic may err by.
//
//   in:      a plan, the bound of an arithmetic, the light of the reference (light64), a picture of the arithmetic
//   out:     errors in light and in codes; values that are stored otherwise than the reference's
//   always:  a value that is no number is infinitely wrong, also where the bound is infinite; each value is held to the
//            bound of its own pixel
#pragma once

#include <cstdint>

#include "capture/picture.hpp"
#include "render/error_bound.hpp"

namespace nutik {

// Between two pictures of light64; codes are those of the bound's format.
struct LightErrors {
  double worst = 0.0;             // in light
  std::uint64_t worst_value = 0;  // where, counted row by row, channels interleaved
  double rms = 0.0;               // root of the mean square, in light
  double worst_8_bit_codes =
      0.0;  // between the places of both on the scale of codes, before they are rounded
  double worst_16_bit_codes = 0.0;
  double share_of_bound = 0.0;  // the largest error in what the bound of its pixel allows
  double bounded_error = 0.0;   // that error, infinite of what is no number,
  double bound = 0.0;           // and what its pixel is allowed
};

[[nodiscard]] LightErrors light_errors(const RenderPlan& plan, const ErrorBound& bound,
                                       const Picture& expected, const Picture& light);

// Between what is stored in a picture's format and what the reference's light would be stored as.
struct StoredErrors {
  std::uint64_t values = 0;
  std::uint64_t differing = 0;
  // How many of those that differ the bound explains: codes whose edge, on the side of the reference's light, lies
  // within the bound of that light; floats within the bound and half of a float's step of it.
  std::uint64_t explained = 0;
};

// `bound` is the one for the picture's own format.
[[nodiscard]] StoredErrors stored_errors(const RenderPlan& plan, const ErrorBound& bound,
                                         const Picture& expected, const Picture& picture);

[[nodiscard]] inline bool is_within_bound(const LightErrors& light, const StoredErrors& stored) {
  return light.share_of_bound <= 1.0 && stored.differing == stored.explained;
}

}  // namespace nutik
