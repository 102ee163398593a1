// Pictures of the lightest, the darkest or the middle sample of each pixel, on the processor.
//
//   in:      a plan whose light is combined so (Combine), of functions without gains below 0
//   out:     of each pixel, over the samples that its function exposes, the largest, the least or the middle value of
//            light · gain; a sample's gain is its function's largest while it is exposed. The middle of an even
//            number of samples is the mean of two. A soft mask blends what its functions come to
//   always:  one gain for all samples rounds nothing: codes are compared as they are
#pragma once

#include "render/renderer.hpp"

namespace nutik {

class CombiningRenderer final : public Renderer {
 public:
  [[nodiscard]] std::string name() const override { return "the processor"; }

 private:
  [[nodiscard]] Rendered render_part(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                     const Rectangle& rectangle, const RenderControl& control) override;
};

}  // namespace nutik
