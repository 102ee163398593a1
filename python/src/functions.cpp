// Gain functions: control points as arrays, the text of function files, shutters, fits. Masks: tags and their shares.
#include <pybind11/operators.h>

#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/corridor_fit.hpp"
#include "exposure/function_text.hpp"
#include "mask/layers.hpp"
#include "parts.hpp"
#include "session/output_check.hpp"
#include "session/requests/named_inputs.hpp"
#include "system/output_file.hpp"

namespace nutik::python {
namespace {

using Times = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Gains = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Points that GainFunction takes.
std::vector<ControlPoint> points_of(const Times& times_ns, const Gains& gains) {
  if (times_ns.ndim() != 1 || gains.ndim() != 1 || times_ns.size() != gains.size())
    throw UsageError("a function has as many times as gains, each an array of one axis");
  if (times_ns.size() == 0) throw UsageError("a function has one control point at least");
  std::vector<ControlPoint> points;
  for (py::ssize_t i = 0; i < times_ns.size(); ++i) {
    const std::int64_t time_ns = times_ns.at(i);
    const double gain = gains.at(i);
    if (!std::isfinite(gain)) throw UsageError(format("control point {}: gain {} is not finite", i, gain));
    if (time_ns > kLargestTimeNs || time_ns < -kLargestTimeNs)
      throw UsageError(format("control point {}: time {} ns lies further away than 126 years", i, time_ns));
    if (i > 0 && time_ns < points.back().time_ns)
      throw UsageError(format("control point {}: time {} ns is not after {} ns; control points must be in time order",
                              i, time_ns, points.back().time_ns));
    if (i > 1 && time_ns == points[points.size() - 2].time_ns)
      throw UsageError(format("control point {}: {} ns is the time of three; a jump has two", i, time_ns));
    points.push_back({time_ns, gain});
  }
  return points;
}

GainFunction fitted(const Times& times_ns, const Gains& gains, double error) {
  const std::vector<ControlPoint> samples = points_of(times_ns, gains);
  const auto [low, high] = std::ranges::minmax(samples, {}, &ControlPoint::gain);
  const Unlocked released;
  return GainFunction(fit_corridor(samples, error, low.gain, high.gain));
}

py::tuple points(const GainFunction& function) {
  std::vector<std::int64_t> times;
  std::vector<double> gains;
  for (const ControlPoint& point : function.points()) {
    times.push_back(point.time_ns);
    gains.push_back(point.gain);
  }
  return py::make_tuple(array_of(times), array_of(gains));
}

GainFunction shutter(const std::string& shape, std::int64_t begin_ns, std::int64_t end_ns, double error) {
  if (!(error >= ShutterShape::kMinError && error < 1.0))
    throw UsageError(format("error={} is no share from {} to 1", error, ShutterShape::kMinError));
  return ShutterShape::parse(shape).function({begin_ns, end_ns}, error);
}

// By tag, and what is suspicious about them.
py::tuple told_of(const FunctionInput& input) { return py::make_tuple(*input.functions, input.warnings); }

py::tuple interval_ns(const std::string& start, const std::string& length) {
  const StatedTime from = StatedTime::parse(start, "start"), stated = StatedTime::parse(length, "exposure");
  if (from.counts_samples() || stated.counts_samples())
    throw UsageError("to count in pictures of a clip its times must be known; write times in seconds");
  const Exposure interval = plain_interval(from, stated, Timeline::constant({1, 1}, Timeline::kFullShutter, 1));
  return py::make_tuple(interval.start_ns, interval.end_ns);
}

std::int64_t nanoseconds(const std::string& time, const std::string& what) {
  const StatedTime stated = StatedTime::parse(time, what);
  if (stated.counts_samples())
    throw UsageError(format("{} '{}' counts pictures, and no clip says when they are; write a time", what, time));
  return stated.nanoseconds();
}

template <typename Code>
using Codes = py::array_t<Code, py::array::c_style | py::array::forcecast>;

template <typename Code>
Picture picture_of(const Codes<Code>& codes, ValueType type, std::uint32_t white) {
  if (codes.ndim() != 2 || codes.size() == 0)
    throw UsageError("a mask is an array of two axes, its height and its width, none of them empty");
  Picture picture({static_cast<std::uint32_t>(codes.shape(1)), static_cast<std::uint32_t>(codes.shape(0)), 1},
                  type, white);
  std::copy_n(codes.data(), codes.size(), picture.values<Code>().begin());
  return picture;
}

HeldMask of_tags(const Codes<std::uint8_t>& tags) {
  return HeldMask(Mask::from_picture(picture_of(tags, ValueType::code8, 255)));
}

HeldMask of_layers(const std::map<std::uint8_t, Codes<std::uint16_t>>& shares, std::uint8_t rest,
                   const py::object& progress) {
  if (shares.empty()) throw UsageError("a mask of layers has one at least");
  std::vector<MaskLayer> layers;
  for (const auto& [tag, codes] : shares)
    layers.push_back({tag, format("layer {}", tag), picture_of(codes, ValueType::code16, kWholeShare)});
  return without_lock(
      [&](const Stopping& stopping) { return HeldMask(mask_of_layers(layers, rest, stopping.progress())); }, progress);
}

HeldMask read_mask(const std::string& path, std::uint8_t rest) {
  const Unlocked released;
  return HeldMask(read_layered_mask_input(path, rest));
}

HeldMask feathered_mask(const HeldMask& held, const std::string& feather, const py::object& progress) {
  const Feather how = Feather::parse(feather);
  if (held->is_soft())
    throw UsageError("feather= blends a mask of tags along its edges; one of layers says itself how it is blended");
  return without_lock(
      [&](const Stopping& stopping) { return HeldMask(feathered(*held, how, stopping.progress())); }, progress);
}

Axes axes(const Mask& mask) { return axes_of({mask.width, mask.height, 1}); }

py::array tags(const py::object& self) {
  const Mask& mask = *self.cast<const HeldMask&>();
  return view_of(py::dtype::of<std::uint8_t>(), axes(mask), mask.tags.data(), self);
}

py::array_t<std::uint16_t> share(const HeldMask& held, std::uint8_t tag) {
  return py::array_t<std::uint16_t>(axes(*held), layer_of(*held, tag).values<std::uint16_t>().data());
}

std::vector<std::uint8_t> tags_in_use(const HeldMask& held) {
  std::vector<std::uint8_t> used;
  for (const MaskRegion& region : regions_of(*held)) used.push_back(region.tag);
  return used;
}

}  // namespace

void bind_functions(py::module_& module) {
  py::class_<GainFunction>(module, "Function")
      .def(py::init([](const Times& times, const Gains& gains) { return GainFunction(points_of(times, gains)); }),
           "times_ns"_a, "gains"_a)
      .def("points", &points)
      .def("shifted_ns", &GainFunction::shifted, "by_ns"_a)
      .def("scaled", &GainFunction::scaled, "factor"_a)
      .def("text", [](const GainFunction& f, std::uint8_t tag) { return function_text(tag, f); }, "tag"_a)
      .def(py::self == py::self);
  module.def("fitted", &fitted, "times_ns"_a, "gains"_a, "error"_a);
  module.def("shutter", &shutter, "shape"_a, "begin_ns"_a, "end_ns"_a, "error"_a);
  module.def("parse_functions", [](const std::string& text, const std::string& title) {
    return told_of(read_functions(text, title));
  }, "text"_a, "title"_a);
  module.def("read_functions", [](const std::string& name) { return told_of(read_function_input(name)); }, "path"_a);
  module.def("write_text", [](const std::string& path, const std::string& text, bool is_picture) {
    check_output(path, is_picture ? OutputKind::picture : OutputKind::functions, {});
    write_text(path, text);
  }, "path"_a, "text"_a, "is_picture"_a);
  module.def("interval_ns", &interval_ns, "start"_a, "length"_a);
  module.def("nanoseconds", &nanoseconds, "time"_a, "what"_a);
  py::class_<HeldMask>(module, "Mask")
      .def(py::init(&of_tags), "tags"_a)
      .def_static("of_layers", &of_layers, "shares"_a, "rest"_a, "progress"_a)
      .def_static("read", &read_mask, "path"_a, "rest"_a)
      .def("feathered", &feathered_mask, "feather"_a, "progress"_a)
      .def("tags", &tags)
      .def("share", &share, "tag"_a)
      .def("tags_in_use", &tags_in_use)
      .def("is_soft", [](const HeldMask& held) { return held->is_soft(); });
  module.attr("WHOLE_SHARE") = kWholeShare;
}

}  // namespace nutik::python
