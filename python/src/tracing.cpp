// How the light of a pixel, or the mean of a mask value's pixels, came about, as arrays.
#include <algorithm>

#include "parts.hpp"

namespace nutik::python {
namespace {

py::dict arrays_of(const TracedExposure& exposure, const Trace& trace) {
  const std::size_t channels = trace.channels;
  std::vector<std::int64_t> edges_ns;
  std::vector<double> gain, light, integral_ns, sum_ns;
  py::array_t<bool> made(static_cast<py::ssize_t>(trace.steps.size()));
  std::ranges::transform(trace.steps, made.mutable_data(), &TraceStep::is_made);
  for (const TraceStep& step : trace.steps) {
    edges_ns.insert(edges_ns.end(), {step.begin_ns, step.end_ns});
    gain.insert(gain.end(), {step.begin_gain, step.end_gain});
    for (std::size_t channel = 0; channel < channels; ++channel)
      light.push_back(step.values[channel].begin_light);
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const TraceStep::Value& value = step.values[channel];
      light.push_back(value.end_light);
      integral_ns.push_back(value.integral_ns);
      sum_ns.push_back(value.sum_ns);
    }
  }
  const auto steps = static_cast<py::ssize_t>(trace.steps.size()), wide = static_cast<py::ssize_t>(channels);
  const PlannedFunction& function = exposure.function_of(trace);
  return py::dict(
      "tag"_a = function.tag, "share"_a = static_cast<double>(trace.share) / kWholeShare,
      "pixels"_a = trace.pixel_count, "times_ns"_a = array_of(edges_ns, {steps, 2}), "gain"_a = array_of(gain, {steps, 2}),
      "light"_a = array_of(light, {steps, 2, wide}), "integral_ns"_a = array_of(integral_ns, {steps, wide}),
      "sum_ns"_a = array_of(sum_ns, {steps, wide}), "made"_a = made,
      "exposed"_a = array_of(std::vector<double>(trace.light.begin(), trace.light.begin() + wide)),
      "support_ns"_a = function.summary.support_ns);
}

// Of a pixel (x, y), or of a mask value where there is none.
py::tuple trace(const OpenCapture& capture, const AskedExposure& asked,
                const std::optional<std::pair<std::uint32_t, std::uint32_t>>& pixel,
                std::optional<std::uint8_t> tag, const py::object& progress) {
  Session& session = *capture.session;
  const TracedExposure exposure = without_lock([&](const Stopping& stopping) {
    return pixel ? session.trace(asked.request, TracedPixel{pixel->first, pixel->second}, stopping.progress())
                 : session.trace(asked.request, TracedTag{tag.value_or(0)}, stopping.progress());
  }, progress);
  py::list traces;
  for (const Trace& each : exposure.traces) traces.append(arrays_of(exposure, each));
  return py::make_tuple(traces, exposure.warnings);
}

}  // namespace

void bind_tracing(py::module_& module) {
  module.def("trace", &trace, "capture"_a, "exposure"_a, "pixel"_a, "tag"_a, "progress"_a);
}

}  // namespace nutik::python
