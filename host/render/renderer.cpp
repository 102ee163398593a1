#include "render/renderer.hpp"

#include "capture/format.hpp"
#include "render/code_scale.hpp"

namespace nutik {
namespace {

void check_white(const OutputFormat& output) {
  const std::uint32_t last = output.type == ValueType::code8 ? 255 : 65'535;
  const bool has_codes = output.type == ValueType::code8 || output.type == ValueType::code16;
  if (!has_codes || (output.white_code >= 1 && output.white_code <= last)) return;
  throw UsageError(format("white cannot have the code {}: codes of {} bits are 0 … {}", output.white_code,
                          output.type == ValueType::code8 ? 8 : 16, last));
}

}  // namespace

Rendered Renderer::render(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                          const RenderControl& control) {
  const Shape& shape = plan.capture.shape;
  const Rectangle rectangle = control.rectangle.value_or(Rectangle::whole(shape));
  if (!rectangle.lies_in(shape)) {
    throw UsageError(format("a rectangle of {} x {} pixels at {},{} is no part of a picture of {} x {}",
                            rectangle.width, rectangle.height, rectangle.x, rectangle.y, shape.width,
                            shape.height));
  }
  check_white(output);
  throw_if_cancelled(control);
  Rendered rendered = render_part(plan, source, output, rectangle, control);
  if (rendered.renderer.empty()) rendered.renderer = name();
  source.check_unchanged();  // blocks may lie where the system maps them, and be read by a device at any time
  state_values(rendered.picture, plan.capture, output);
  return rendered;
}

}  // namespace nutik
