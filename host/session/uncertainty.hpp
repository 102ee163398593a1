// What a picture's light may be off by, term by term (docs/explanation/uncertainty.md).
//
//   in:      an exposure: its bound, its format, what its capture is known to be
//   out:     a list, from which text, JSON and Python's dictionaries are written
//   always:  of the pixel that may be off furthest. Bounds hold for every pixel and may be added up; what is no bound
//            is told beside them
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "capture/code_roundings.hpp"
#include "capture/made_samples.hpp"
#include "render/error_bound.hpp"
#include "render/render_plan.hpp"

namespace nutik {

struct ExposedPicture;

// What samples are off by, by their own light: straight between its points, of which there are two or none.
class LightCurve {
 public:
  struct Point {
    double light = 0.0, off = 0.0;
  };

  LightCurve() = default;
  // By increasing light.
  explicit LightCurve(std::vector<Point> points);
  // The least that bends down everywhere and lies below none of them. A mean of samples, whose weights are not
  // negative, is off by no more than the curve says of that mean.
  [[nodiscard]] static LightCurve above(const std::vector<Point>& points);
  // The same of the lightest, darkest or middle sample: of a curve that bends down.
  [[nodiscard]] LightCurve of_order() const;

  [[nodiscard]] bool is_zero() const { return points_.empty(); }
  [[nodiscard]] double at(double light) const;
  // The most of what lies between two lights, if it bends down; of any.
  [[nodiscard]] double most(double from, double to) const;
  [[nodiscard]] double most() const { return points_.empty() ? 0.0 : top_.off; }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  std::vector<Point> points_;
  Point top_;
};

// What a capture is known to be off by before anything is exposed.
struct CaptureErrors {
  LightCurve rounded;  // between light and the code that was made of it here
  LightCurve held;     // between what a sample had and what is held of it: its tolerance, its noise's sigmas
  LightCurve noise;    // a sample's standard deviation, in its noisiest channel; zero: not known
  std::optional<double> alignment_pixels = std::nullopt;
  std::optional<MadeSamples> made = std::nullopt;
  std::vector<std::string> unbounded = {};  // how codes were made whose error nobody knows

  [[nodiscard]] static CaptureErrors of(const CaptureFormat& capture, const CodeRoundings& roundings);
  // Where samples are combined.
  [[nodiscard]] CaptureErrors of_order() const;
};

// Light that a picture of codes may be off by, by that light.
class CodeErrors {
 public:
  CodeErrors(const CaptureFormat& capture, const OutputFormat& output);

  [[nodiscard]] const CodeMaking& making() const { return making_; }
  // In codes, where shown light between two others changes by so much; and wherever that is worst, `scale` being S.
  [[nodiscard]] double between(double from, double to, double light) const;
  [[nodiscard]] double anywhere(double light, double scale) const;

 private:
  CodeMaking making_;
  std::uint32_t white_code_;
};

struct UncertaintyTerm {
  enum class Is { bound, deviation, count, no_bound };
  // Those of which a map has a layer, in its order; how codes were made is told by name alone.
  enum Known : std::size_t {
    kAllBounds, kArithmetic, kRounding, kRoundedCodes, kHeldSamples, kTimes, kNoise, kAlignment, kMadeSamples, kTerms
  };
  struct Kind {
    std::string_view name;
    Is is;
    std::string_view covers;  // of a pixel
  };
  static constexpr Kind kKinds[kTerms] = {
      {"all_bounds", Is::bound, "no pixel is further off by all bounds together"},
      {"arithmetic", Is::bound, "no pixel is further off"},
      {"rounding", Is::bound, "no pixel is further off"},
      {"rounded_codes", Is::bound, "no pixel is further off"},
      {"held_samples", Is::bound, "no pixel is further off"},
      {"times", Is::bound, "no pixel is further off"},
      {"noise", Is::deviation,
       "one standard deviation (k = 1) of a sample as bright as the pixel, 68 % if it is normal"},
      {"alignment", Is::deviation,
       "half of the texture is no further off: the residual times the slope of the picture"},
      {"made_samples", Is::count, "the share of exposed samples that nobody filmed"},
  };

  std::string_view name;  // as scripts know it
  Is is = Is::bound;
  std::optional<PictureError> error = std::nullopt;
  std::vector<std::pair<std::string_view, double>> figures = {};  // what is no light, with the unit in the name
  std::string text = {};

  // By the names that JSON and Python have: `term`, `is`, `light`, and `codes` or `float_steps`, figures.
  using Field = std::pair<std::string_view, std::variant<std::string_view, double>>;
  [[nodiscard]] std::vector<Field> fields(const OutputFormat& output) const;
};

[[nodiscard]] std::string_view to_text(UncertaintyTerm::Is is);

struct Uncertainty {
  double scale = 0.0;  // S: the largest ∫|g| / D of a function; of light that is combined the largest gain
  std::vector<UncertaintyTerm> terms;
  // All of them: their lights added up. In codes it is what that sum costs where it costs most, which may be less than
  // their codes added up.
  UncertaintyTerm bounds;

  [[nodiscard]] static Uncertainty of(const ExposedPicture& exposed, const CaptureErrors& capture);
  // A line for each term.
  [[nodiscard]] std::vector<std::string> lines(const OutputFormat& output) const;
};

// Both ends of a sample are rounded to whole nanoseconds, and so is D: what the light of a function misses by that.
[[nodiscard]] double times_error(const PlannedFunction& function, const Timeline& timeline);
// Whether no gain is below 0: light is a mean of samples then, but for a factor.
[[nodiscard]] bool is_mean(const PlannedFunction& function);

}  // namespace nutik
