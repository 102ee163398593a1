// The scalar reference: what a picture is, computed the way docs/explanation/model.md defines it.
#pragma once

#include "render/renderer.hpp"

namespace nutik {

// Walks every edge (change record or control point) of a pixel in time order and sums the exact integral
// of light × gain over each interval between edges, in double with compensated summation. Shares no
// evaluation code with the packed tables or the kernels: it reads the plan's functions, not its tables.
class ReferenceRenderer final : public Renderer {
 public:
  [[nodiscard]] std::string name() const override { return "scalar reference"; }

 private:
  [[nodiscard]] Rendered render_part(const RenderPlan& plan, CaptureSource& source,
                                     const OutputFormat& output, const Rectangle& rectangle,
                                     const RenderControl& control) override;
};

}  // namespace nutik
