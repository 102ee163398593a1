// From light to codes on the host, where light below 0 is to be seen or primaries are converted: and which light no
// code is left for.
//
//   in:      light as floating point, of which 1 is white, a picture's transfer function, white code and NegativeLight
//   out:     codes 0 … white code, and how many pixels saturate at either end
//   always:  light 0 and light 1 never saturate, nor does what rounds to their codes
//
// docs/explanation/model.md has the formulas.
#pragma once

#include <cstdint>
#include <utility>

#include "capture/picture.hpp"
#include "render/output_format.hpp"
#include "render/render_plan.hpp"

namespace nutik {

class CodeScale {
 public:
  CodeScale(const Transfer& transfer, const OutputFormat& output);

  [[nodiscard]] std::uint32_t code_of(double light) const;

  // Whether the code would be less than 0, or more than the white code, if there were such codes.
  [[nodiscard]] bool saturates_below(double light) const { return light < lowest_; }
  [[nodiscard]] bool saturates_above(double light) const {
    return light >= highest_ || (folds_ && -light >= highest_);
  }
  // Light below the first saturates below, light from the second on above.
  [[nodiscard]] std::pair<double, double> limits() const { return {lowest_, highest_}; }

 private:
  Transfer transfer_;
  std::uint32_t white_code_;
  NegativeLight negative_;
  std::uint32_t half_;  // codes of either sign with offset
  bool folds_;
  double lowest_;
  double highest_;
};

// Light of a capture (light64) becomes what its codes are made of: white is 1, in the primaries of the codes.
void to_shown_light(Picture& light, const CodeMaking& making);

// How many pixels of shown light (light64) saturate. A pixel counts once at an end, whatever its channels are.
[[nodiscard]] Saturation count_saturated(const Picture& light, const CodeScale& scale);

// The codes of a picture of shown light (light64), in the format asked for. `has_few_lights`: most of its lights occur
// again and again, as where samples are combined.
[[nodiscard]] Picture encoded(const Picture& light, const CodeScale& scale, const OutputFormat& output,
                              bool has_few_lights = false);

// Light of a capture (light64) as values of the type asked for; what saturates is added.
[[nodiscard]] Picture stored(Picture light, const CaptureFormat& capture, const OutputFormat& output,
                             Saturation& saturation, bool has_few_lights = false);

// Has a picture of a capture say what its values mean, and how it is to be shown.
void state_values(Picture& picture, const CaptureFormat& capture, const OutputFormat& output);

// Whether some light of [0, 1] can saturate at all under the plan's functions: told from ∫g and ∫|g|.
[[nodiscard]] bool can_saturate(const RenderPlan& plan, const CodeMaking& making, const CodeScale& scale);

}  // namespace nutik
