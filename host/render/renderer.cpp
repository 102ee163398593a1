#include "render/renderer.hpp"

#include "capture/format.hpp"
#include "render/code_scale.hpp"
#include "system/mapped_file.hpp"

namespace nutik {

Rendered Renderer::render(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                          const RenderControl& control) {
  const Shape& shape = plan.capture.shape;
  const Rectangle rectangle = control.rectangle.value_or(Rectangle::whole(shape));
  if (!rectangle.lies_in(shape)) {
    throw UsageError(format("a rectangle of {} x {} pixels at {},{} is no part of a picture of {} x {}",
                            rectangle.width, rectangle.height, rectangle.x, rectangle.y, shape.width,
                            shape.height));
  }
  throw_if_cancelled(control);
  Rendered rendered = render_part(plan, source, output, rectangle, control);
  check_mapped_files();  // blocks may lie where the system maps them, and be read by a device at any time
  state_values(rendered.picture, plan.capture, output);
  return rendered;
}

}  // namespace nutik
