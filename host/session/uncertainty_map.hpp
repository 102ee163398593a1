// What each pixel of a picture may be off by, term by term (docs/explanation/uncertainty.md).
//
//   in:      a plan and its bound, what its capture is off by, the picture
//   out:     a layer of all bounds together, and one for each term: in codes of a picture of codes, else in light
//   always:  by the pixel's own function, by its own light if no gain is below 0, and by the channel that is off
//            furthest; rounded up
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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
  // All of which must live as long; `capture` is of_order() where the plan combines samples.
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
  using Term = UncertaintyTerm::Known;
  using enum UncertaintyTerm::Known;
  // What a function gives its pixels; a pixel that several share has its shares of theirs.
  struct Function {
    double scale = 0.0, times = 0.0, made = 0.0;
    bool is_mean = true;
  };
  // By term, in light or in the picture's steps; light64 counts in light, as floats do.
  struct Errors {
    double of[kTerms] = {};
  };
  // Light that lies between two others, `at` if it is where it seems to be.
  struct Span {
    double from = 0.0, at = 0.0, to = 0.0;
  };

  [[nodiscard]] static Errors worst_of(Errors a, const Errors& b);
  [[nodiscard]] Function function_of(std::uint64_t pixel) const;
  // What light of the capture is off by, but for `own`, the arithmetic's error, where it lies.
  [[nodiscard]] Errors lights(const Span& light, const Function& function, double own) const;
  // Where shown light lay that became this code. Codes end at black and white: `all` light lies between its ends.
  [[nodiscard]] Span shown(double code, const Span& all) const;
  // What codes are off by whose shown light is off by so much; without `shown` wherever that is worst, by the capture's
  // light.
  [[nodiscard]] Errors in_codes(const std::optional<Span>& shown, const Errors& light, double scale,
                                const PictureError& arithmetic) const;
  // What a value is off by that is made by this function with this error of the arithmetic.
  [[nodiscard]] Errors of_code(double code, const Function& function, const PictureError& arithmetic) const;
  [[nodiscard]] Errors of_light(double light, const Function& function, const PictureError& arithmetic) const;
  // The worst of a pixel's three codes in other primaries, each of which has shares of the errors of three lights.
  [[nodiscard]] Errors of_colour(const std::array<double, 3>& codes, const Function& function,
                                 const PictureError& arithmetic) const;
  // How much a value changes from one pixel to the next, at its place in the picture.
  [[nodiscard]] static double slope_at(const Picture& exposed, std::uint32_t x, std::uint32_t y);
  [[nodiscard]] bool has(Term term) const;
  [[nodiscard]] std::string text_of(Term term) const;

  const RenderPlan& plan_;
  const CaptureErrors& capture_;
  OutputFormat output_;
  PixelErrors arithmetic_;
  CodeErrors codes_;
  double threshold_;  // in light: what thresholds between codes are rounded by
  std::vector<Function> functions_;
  ColourMatrix back_{};  // to the capture's primaries from the picture's, where they differ
};

}  // namespace nutik
