// Pictures of the lightest, the darkest or the middle sample of each pixel: the scalar reference of kernels/combine.cl,
// and what makes the middle one, for which all samples have to be there.
//
//   in:      a plan whose light is combined so (Combine), of functions without gains below 0
//   out:     of each pixel, over the samples that its function exposes, the largest, the least or the middle value of
//            light · gain; a sample's gain is its function's largest while it is exposed, jumps of 1 ns left out. A
//            function that exposes nothing but the time between two samples' exposures takes the one before it. The
//            middle of an even number of samples is the mean of two. A soft mask blends what its functions come to
//   always:  products are rounded once, and nothing else is but what soft masks blend
#pragma once

#include <vector>

#include "render/renderer.hpp"

namespace nutik {

// A function as its samples see it.
struct SampleGains {
  SampleRange samples;
  std::vector<double> gains;  // of each: the largest while it is exposed

  // Throws UsageError for one below 0.
  SampleGains(const PlannedFunction& planned, const Timeline& timeline, std::int64_t duration_ns);
};
// By planned function.
[[nodiscard]] std::vector<SampleGains> sample_gains(const RenderPlan& plan, const Timeline& timeline);

class CombiningRenderer final : public Renderer {
 public:
  [[nodiscard]] std::string name() const override { return "the processor"; }

 private:
  [[nodiscard]] Rendered render_part(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                     const Rectangle& rectangle, const RenderControl& control) override;
};

}  // namespace nutik
