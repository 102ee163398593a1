#include "render/renderer.hpp"

#include "capture/format.hpp"
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
  Picture& picture = rendered.picture;
  picture.primaries = plan.capture.primaries;
  picture.pixel_aspect = plan.capture.pixel_aspect;
  if (holds_codes(output.type)) {
    const CodeMaking making = CodeMaking::of(plan.capture, output);
    picture.transfer = making.transfer;
    picture.primaries = making.primaries;
  }
  return rendered;
}

}  // namespace nutik
