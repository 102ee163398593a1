#include "render/rendering_report.hpp"

#include "capture/format.hpp"

namespace nutik {

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
