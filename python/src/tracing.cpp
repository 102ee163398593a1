// How the light of a pixel, or the mean of a mask value's pixels, came about, as arrays.
#include "parts.hpp"

namespace nutik::python {
namespace {

py::dict arrays_of(const TracedExposure& exposure, const Trace& trace) {
  const PlannedFunction& function = exposure.function_of(trace);
  return py::dict("tag"_a = function.tag, "share"_a = static_cast<double>(trace.share) / kWholeShare,
                  "pixels"_a = trace.pixel_count, "steps"_a = array_of(trace.steps),
                  "exposed"_a = array_of(std::vector(trace.light.begin(), trace.light.begin() + trace.channels)),
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
  PYBIND11_NUMPY_DTYPE(TraceStep::Value, begin_light, end_light, integral_ns, sum_ns);
  PYBIND11_NUMPY_DTYPE(TraceStep, begin_ns, end_ns, begin_gain, end_gain, is_made, values);
  module.def("trace", &trace, "capture"_a, "exposure"_a, "pixel"_a, "tag"_a, "progress"_a);
}

}  // namespace nutik::python
