// Gain functions: their control points as arrays, the text of function files, shutters, fits.
#include <pybind11/stl.h>

#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/corridor_fit.hpp"
#include "exposure/function_text.hpp"
#include "parts.hpp"
#include "session/requests/function_input.hpp"
#include "system/output_file.hpp"

namespace nutik::python {
namespace {

using Times = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Gains = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<ControlPoint> points_of(const Times& times_ns, const Gains& gains) {
  if (times_ns.ndim() != 1 || gains.ndim() != 1 || times_ns.size() != gains.size())
    throw UsageError("a function has as many times as gains, each an array of one axis");
  std::vector<ControlPoint> points;
  points.reserve(static_cast<std::size_t>(times_ns.size()));
  for (py::ssize_t i = 0; i < times_ns.size(); ++i) points.push_back({times_ns.at(i), gains.at(i)});
  return points;
}

// What GainFunction takes for granted.
void check(const std::vector<ControlPoint>& points) {
  if (points.empty()) throw UsageError("a function has one control point at least");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [time_ns, gain] = points[i];
    if (!std::isfinite(gain)) throw UsageError(format("control point {}: gain {} is not finite", i, gain));
    if (time_ns > kLargestTimeNs || time_ns < -kLargestTimeNs)
      throw UsageError(format("control point {}: time {} ns lies further away than 126 years", i, time_ns));
    if (i > 0 && time_ns < points[i - 1].time_ns) {
      throw UsageError(
          format("control point {}: time {} ns is not after {} ns; control points must be in time "
                 "order",
                 i, time_ns, points[i - 1].time_ns));
    }
    if (i > 1 && time_ns == points[i - 2].time_ns) {
      throw UsageError(format("control point {}: {} ns is the time of three; a jump has two", i, time_ns));
    }
  }
}

HeldFunction from_points(const Times& times_ns, const Gains& gains) {
  std::vector<ControlPoint> points = points_of(times_ns, gains);
  check(points);
  return {GainFunction(std::move(points))};
}

HeldFunction fitted(const Times& times_ns, const Gains& gains, double error) {
  const std::vector<ControlPoint> samples = points_of(times_ns, gains);
  check(samples);
  if (samples.size() < 2) throw UsageError("a fit needs two samples at least");
  double low = samples[0].gain, high = low;
  for (const ControlPoint& sample : samples) {
    low = std::min(low, sample.gain);
    high = std::max(high, sample.gain);
  }
  const Unlocked released;
  return {GainFunction(fit_corridor(samples, error, low, high))};
}

py::tuple points(const HeldFunction& held) {
  std::vector<std::int64_t> times;
  std::vector<double> gains;
  for (const ControlPoint& point : held.function.points()) {
    times.push_back(point.time_ns);
    gains.push_back(point.gain);
  }
  return py::make_tuple(array_of(times), array_of(gains));
}

HeldFunction shutter(const std::string& shape, std::int64_t begin_ns, std::int64_t end_ns, double error) {
  if (!(error >= ShutterShape::kMinError && error < 1.0))
    throw UsageError(format("error={} is no share from {} to 1", error, ShutterShape::kMinError));
  return {ShutterShape::parse(shape).function({begin_ns, end_ns}, error)};
}

py::tuple parsed(const std::string& text, const std::string& title) {
  const FunctionInput input = read_functions(text, title);
  return py::make_tuple(held_functions(*input.functions), input.warnings);
}

py::tuple read(const std::string& path) {
  const FunctionInput input = read_function_input(path);
  return py::make_tuple(held_functions(*input.functions), input.warnings);
}

py::tuple interval_ns(const std::string& start, const std::string& length) {
  const StatedTime from = StatedTime::parse(start, "start"), stated = StatedTime::parse(length, "exposure");
  if (from.counts_samples() || stated.counts_samples())
    throw UsageError("to count in pictures of a clip its times must be known; write times in seconds");
  const Exposure interval =
      plain_interval(from, stated, Timeline::constant({1, 1}, Timeline::kFullShutter, 1));
  return py::make_tuple(interval.start_ns, interval.end_ns);
}

std::int64_t nanoseconds(const std::string& time, const std::string& what) {
  const StatedTime stated = StatedTime::parse(time, what);
  if (stated.counts_samples())
    throw UsageError(
        format("{} '{}' counts pictures, and no clip says when they are; write a time", what, time));
  return stated.nanoseconds();
}

}  // namespace

void bind_functions(py::module_& module) {
  py::class_<HeldFunction>(module, "Function")
      .def(py::init(&from_points), py::arg("times_ns"), py::arg("gains"))
      .def("points", &points)
      .def(
          "shifted_ns",
          [](const HeldFunction& held, std::int64_t by) { return HeldFunction{held.function.shifted(by)}; },
          py::arg("by_ns"))
      .def(
          "scaled",
          [](const HeldFunction& held, double factor) { return HeldFunction{held.function.scaled(factor)}; },
          py::arg("factor"))
      .def(
          "text",
          [](const HeldFunction& held, std::uint8_t tag) { return function_text(tag, held.function); },
          py::arg("tag"))
      .def(
          "__eq__", [](const HeldFunction& a, const HeldFunction& b) { return a.function == b.function; },
          py::arg("other"), py::is_operator());
  module.def("fitted", &fitted, py::arg("times_ns"), py::arg("gains"), py::arg("error"));
  module.def("shutter", &shutter, py::arg("shape"), py::arg("begin_ns"), py::arg("end_ns"), py::arg("error"));
  module.def("parse_functions", &parsed, py::arg("text"), py::arg("title"));
  module.def("read_functions", &read, py::arg("path"));
  module.def(
      "write_text", [](const std::string& path, const std::string& text) { write_text(path, text); },
      py::arg("path"), py::arg("text"));
  module.def("interval_ns", &interval_ns, py::arg("start"), py::arg("length"));
  module.def("nanoseconds", &nanoseconds, py::arg("time"), py::arg("what"));
  module.attr("MIN_ERROR") = ShutterShape::kMinError;
}

}  // namespace nutik::python
