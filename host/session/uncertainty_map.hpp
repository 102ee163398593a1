// What each pixel of a picture may be off by, term by term (docs/explanation/uncertainty.md).
//
//   in:      a plan and its bound, what its capture is off by, the picture
//   out:     a layer of all bounds together, and one for each term: in codes of a picture of codes, else in light
//   always:  by the pixel's own function, by its own light if no gain is below 0, and by the channel that is off
//            furthest; rounded up
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "render/error_bound.hpp"
#include "render/render_plan.hpp"
#include "render/renderer.hpp"
#include "session/uncertainty.hpp"

namespace nutik {

class UncertaintyMap {
 public:
  // All of which must live as long.
  UncertaintyMap(const RenderPlan& plan, const Timeline& timeline, const ErrorBound& bound,
                 const CaptureErrors& capture);

  // What maps of so many pixels take.
  [[nodiscard]] static std::uint64_t bytes(const Shape& shape) { return kTerms * sizeof(float) * shape.pixel_count(); }

  // `exposed` has the plan's pixels of `part`. On all cores; progress counts rows. Throws Cancelled.
  [[nodiscard]] std::vector<PictureLayer> layers(const Picture& exposed, const Rectangle& part,
                                                 const RenderControl& control = {}) const;

  // For a picture of codes: no pixel's bounds together are more than the whole picture's. Both hold, and the picture's
  // are found in finer parts of light than a code.
  static void limit(std::vector<PictureLayer>& layers, const PictureError& bounds);

 private:
  enum Term : std::size_t {
    kAllBounds, kArithmetic, kRounding, kRoundedCodes, kHeldSamples, kTimes, kNoise, kAlignment, kMadeSamples, kTerms
  };
  // What a function gives its pixels; a pixel that several share has its shares of theirs.
  struct Function {
    double scale = 0.0, times = 0.0, made = 0.0;
    bool is_mean = true;
  };
  // By term, in the picture's steps; light64 counts in light, as floats do.
  struct Errors {
    double of[kTerms] = {};
  };

  [[nodiscard]] Function function_of(std::uint64_t pixel) const;
  // What one value is off by, made by this function with this error of the arithmetic.
  [[nodiscard]] Errors of_code(double code, const Function& function, const PictureError& arithmetic) const;
  [[nodiscard]] Errors of_light(double light, const Function& function, const PictureError& arithmetic) const;
  // How much a value changes from one pixel to the next, at its place in the picture.
  [[nodiscard]] static double slope_at(const Picture& exposed, std::uint32_t x, std::uint32_t y);
  [[nodiscard]] bool has(Term term) const;
  [[nodiscard]] std::string text_of(Term term) const;

  const RenderPlan& plan_;
  const CaptureErrors& capture_;
  OutputFormat output_;
  PixelErrors arithmetic_;
  CodeErrors codes_;
  std::vector<Function> functions_;
};

}  // namespace nutik
