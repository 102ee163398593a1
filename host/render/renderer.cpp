#include "render/renderer.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
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

void add_part(Rendered& whole, const Rendered& part, bool is_made_beside) {
  whole.saturation += part.saturation;
  whole.passed_self_test &= part.passed_self_test;
  std::ranges::copy_if(part.warnings, std::back_inserter(whole.warnings), [&](const std::string& text) {
    return std::ranges::count(whole.warnings, text) == 0;
  });
  RenderStatistics& all = whole.statistics;
  const RenderStatistics& took = part.statistics;
  // Times run side by side or add up; what is held, the other way round.
  const auto add = [](auto& to, auto more, bool adds_up) { to = adds_up ? to + more : std::max(to, more); };
  for (const auto time : {&RenderStatistics::read_ms, &RenderStatistics::expose_ms, &RenderStatistics::develop_ms})
    add(all.*time, took.*time, !is_made_beside);
  all.is_timed &= took.is_timed;
  add(all.device_bytes, took.device_bytes, is_made_beside);
  all.table_bytes_written += took.table_bytes_written;
  all.map_bytes_written += took.map_bytes_written;
  all.launches += took.launches;
  // Each reads the same blocks.
  add(all.payload_bytes, took.payload_bytes, !is_made_beside);
  for (const auto of_blocks : {&RenderStatistics::blocks, &RenderStatistics::exposed_functions,
                               &RenderStatistics::kept_sums, &RenderStatistics::made_sums})
    add(all.*of_blocks, took.*of_blocks, false);
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
