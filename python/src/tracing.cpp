// How the light of a pixel, or the mean of a mask value's pixels, came about, as arrays.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "parts.hpp"
#include "working.hpp"

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
  py::dict arrays;
  arrays["tag"] = exposure.function_of(trace).tag;
  arrays["share"] = static_cast<double>(trace.share) / kWholeShare;
  arrays["pixels"] = trace.pixel_count;
  arrays["times_ns"] = array_of(edges_ns, {steps, 2});
  arrays["gain"] = array_of(gain, {steps, 2});
  arrays["light"] = array_of(light, {steps, 2, wide});
  arrays["integral_ns"] = array_of(integral_ns, {steps, wide});
  arrays["sum_ns"] = array_of(sum_ns, {steps, wide});
  arrays["made"] = made;
  arrays["exposed"] = array_of(std::vector<double>(trace.light.begin(), trace.light.begin() + wide));
  arrays["support_ns"] = exposure.function_of(trace).summary.support_ns;
  return arrays;
}

// Of a pixel (x, y), or of a mask value where there is none.
py::tuple trace(const OpenCapture& capture, const AskedExposure& asked,
                const std::optional<std::pair<std::uint32_t, std::uint32_t>>& pixel,
                std::optional<std::uint8_t> tag, const py::object& progress) {
  const ExposureRequest request = exposure_request(asked);
  Session& session = *capture.session;
  const TracedExposure exposure = without_lock([&](const Stopping& stopping) {
    return pixel ? session.trace(request, TracedPixel{pixel->first, pixel->second}, stopping.progress())
                 : session.trace(request, TracedTag{tag.value_or(0)}, stopping.progress());
  }, progress);
  py::list traces;
  for (const Trace& each : exposure.traces) traces.append(arrays_of(exposure, each));
  const std::array<double, 3> light = light_of(exposure.traces);
  const auto channels = static_cast<std::ptrdiff_t>(session.format().shape.channels);
  return py::make_tuple(traces, array_of(std::vector<double>(light.begin(), light.begin() + channels)),
                        exposure.warnings);
}

}  // namespace

void bind_tracing(py::module_& module) {
  module.def("trace", &trace, py::arg("capture"), py::arg("exposure"), py::arg("pixel"), py::arg("tag"),
             py::arg("progress"));
}

}  // namespace nutik::python
