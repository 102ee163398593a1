#include "render/renderer.hpp"

#include <algorithm>
#include <bit>
#include <utility>

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

PrecisionChoice choose_precision(const RenderPlan& plan, const OutputFormat& output,
                                 std::span<const Precision> available) {
  measure_tables(plan);
  std::vector<ErrorBound> rejected;
  for (const Precision precision : available) {
    ErrorBound bound = error_bound(plan, precision, output);
    if (bound.worst.steps <= kMaxSteps) return {std::move(bound), std::move(rejected)};
    rejected.push_back(std::move(bound));
  }
  const auto best = std::min_element(rejected.begin(), rejected.end(), [](const auto& a, const auto& b) {
    return std::pair(a.worst.steps, a.worst.light) < std::pair(b.worst.steps, b.worst.light);
  });
  ErrorBound bound = std::move(*best);
  rejected.erase(best);
  return {std::move(bound), std::move(rejected)};
}

void check_reference_strictly(const RenderPlan& plan, const OutputFormat& output) {
  const ErrorBound bound = reference_bound(plan, output);
  if (bound.worst.steps <= kMaxSteps) return;
  throw ImpreciseError(format("{}: {}; smaller gains, or gains that cancel less, may be",
                              not_sure_text("the reference", output), error_text(bound.worst, output)));
}

std::string half_step_text(const OutputFormat& output) {
  return format("{} of a {}", kMaxSteps,
                holds_codes(output.type) ? "code" : output.is_half ? "half's step" : "float's step");
}

std::string not_sure_text(std::string_view who, const OutputFormat& output) {
  return format("{} is not sure to be right to {} here", who, half_step_text(output));
}

std::string error_text(const PictureError& error, const OutputFormat& output) {
  const std::string light = format("light within {:.2g}", error.light);
  if (output.type == ValueType::light64) return light;
  const bool is_power_of_two = std::has_single_bit(output.white_code + 1);
  const bool is_one = error.steps < 1.0;
  const char* plural = is_one ? "" : "s";
  const std::string step =
      output.type == ValueType::light32 ? format("{}'s step{}", output.is_half ? "half" : "float", plural)
      : is_power_of_two                 ? format("{}-bit code{}", std::bit_width(output.white_code), plural)
                                        : format("code{} of {}", plural, output.white_code);
  const std::string_view article = step.starts_with('8') || step.starts_with("11-") ? "of an " : "of a ";
  return is_one ? format("{}, {:.2g} {}{}", light, error.steps, article, step)
                : format("{}, {:.3g} {}", light, error.steps, step);
}

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

std::string rendering_report(const Rendered& rendered, const OutputFormat& output) {
  if (!rendered.choice) return {};
  const RenderStatistics& took = rendered.statistics;
  const double megabytes = static_cast<double>(took.payload_bytes) * 1e-6;
  std::string text =
      format("{} precision; {} block{} of {:.1f} MB made ready in {:.1f} ms, ", to_text(rendered.precision),
             took.blocks, took.blocks == 1 ? "" : "s", megabytes, took.read_ms);
  if (took.kept_sums > 0)
    text += format("{} sum{} of others kept, ", took.kept_sums, took.kept_sums == 1 ? "" : "s");
  text += took.is_timed
              ? format("read by the kernel in {:.1f} ms ({:.1f} GB/s); codes or light in {:.1f} ms",
                       took.expose_ms, took.expose_ms > 0 ? megabytes / took.expose_ms : 0.0, took.develop_ms)
              : "kernels not timed by this driver";
  text += format("; at most {:.1f} MB on the device", static_cast<double>(took.device_bytes) * 1e-6);
  text += format("\n{}: {}", to_text(rendered.precision), error_text(rendered.choice->bound.worst, output));
  for (const ErrorBound& bound : rendered.choice->rejected) {
    text += format("; not {}: only {}", to_text(bound.precision), error_text(bound.worst, output));
  }
  return text;
}

}  // namespace nutik
