// Exposures: what is asked for, the picture, and the plan's figures.
#include <pybind11/stl.h>

#include <cmath>

#include "parts.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/requests/output_request.hpp"
#include "working.hpp"

namespace nutik::python {
namespace {

std::string stated(const Settings& settings, const std::string& name, const std::string& otherwise) {
  const auto found = settings.find(name);
  return found == settings.end() ? otherwise : found->second;
}

double number(const Settings& settings, const std::string& name, double otherwise) {
  const auto found = settings.find(name);
  return found == settings.end() ? otherwise : std::stod(found->second);
}

NegativeLight negative_light(const std::string& text) {
  if (text == "saturate") return NegativeLight::saturate;
  if (text == "offset") return NegativeLight::offset;
  if (text == "abs") return NegativeLight::absolute;
  throw UsageError(format("negative='{}' is not known; choose 'saturate', 'offset' or 'abs'", text));
}

ValueType value_type(const std::string& name) {
  if (name == "uint8") return ValueType::code8;
  if (name == "uint16") return ValueType::code16;
  return name == "float64" ? ValueType::light64 : ValueType::light32;
}

py::object bound_of(const ExposedPicture& exposed) {
  if (!exposed.choice) return py::none();
  py::dict bound;
  bound["light"] = exposed.choice->bound.worst.light;
  bound["steps"] = exposed.choice->bound.worst.steps;
  return bound;
}

py::list functions_of_plan(const ExposureFigures& figures) {
  py::list functions;
  for (const PlannedFunction& planned : figures.functions) {
    py::dict function;
    function["tag"] = planned.tag;
    function["pixels"] = planned.pixel_count;
    function["live_ns"] = py::make_tuple(planned.summary.live.begin_ns, planned.summary.live.end_ns);
    function["samples"] = exposed_samples(planned, figures.timeline).size();
    function["still_gain"] = planned.summary.still_gain();
    function["support_ns"] = planned.summary.support_ns;
    function["integral_ns"] = std::scalbn(planned.summary.integral_ns, planned.summary.exponent);
    functions.append(std::move(function));
  }
  return functions;
}

HeldPicture render(const OpenCapture& capture, const AskedExposure& asked, const Settings& output,
                   const std::optional<std::array<std::uint32_t, 4>>& region,
                   const std::optional<std::string>& precision) {
  Session& session = *capture.session;
  const ExposureRequest request = exposure_request(asked);
  const OutputFormat format = output_of(output, session.format());
  RenderControl control;
  if (precision) control.precision = parse_precision(*precision);
  if (region) control.rectangle = Rectangle{(*region)[0], (*region)[1], (*region)[2], (*region)[3]};
  ExposedPicture exposed = without_lock([&](const Stopping& stopping) {
    control.stop = stopping.stop;
    return session.render(request, format, control);
  });
  py::dict figures = figures_of(exposed);
  return {std::move(exposed.picture), std::move(figures)};
}

// In words, or the time of each pixel in nanoseconds, [height, width].
using DelayTimes = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
std::optional<DelayRequest> delay_of(const std::optional<DelayTimes>& times_ns, const Settings& settings) {
  if (times_ns) {
    if (times_ns->ndim() != 2 || times_ns->size() == 0) {
      throw UsageError(
          "delay= is an array of two axes, the picture's height and its width, none of them empty");
    }
    return DelayRequest::of_times(static_cast<std::uint32_t>(times_ns->shape(1)),
                                  static_cast<std::uint32_t>(times_ns->shape(0)),
                                  {times_ns->data(), static_cast<std::size_t>(times_ns->size())});
  }
  const auto stated = settings.find("delay");
  if (stated == settings.end()) return std::nullopt;
  DelayRequest request = DelayRequest::parse(stated->second, "delay");
  request.read();
  return request;
}

}  // namespace

ExposureRequest exposure_request(const AskedExposure& asked) {
  const Settings& settings = asked.settings;
  ExposureRequest request;
  request.start = StatedTime::parse(stated(settings, "start", "0s"), "start");
  request.normalization = Normalization::parse(stated(settings, "normalize", "support"));
  request.gain = number(settings, "gain", 1.0);
  if (!std::isfinite(request.gain) || request.gain == 0.0)
    throw UsageError(format("gain={} makes a picture of nothing; choose a number nearer to 1", request.gain));
  request.unmapped_is_zero = settings.contains("unmapped");
  if (asked.functions) {
    request.gains = Shared(set_of(*asked.functions));
  } else {
    const double error = number(settings, "shutter_error", ShutterShape::kDefaultError);
    if (!(error >= ShutterShape::kMinError && error < 1.0))
      throw UsageError(format("shutter_error={} is no share from {} to 1", error, ShutterShape::kMinError));
    request.gains = PlainInterval{StatedTime::parse(stated(settings, "exposure", ""), "exposure"),
                                  Shutter(ShutterShape::parse(stated(settings, "shutter", "box")), error)};
  }
  if (asked.mask) request.mask = Shared(MaskWithRegions(*asked.mask->mask));
  request.delay = asked.delay;
  return request;
}

OutputFormat output_of(const Settings& settings, const CaptureFormat& capture) {
  const ValueType type = value_type(stated(settings, "dtype", "float32"));
  OutputRequest request;
  request.depth = type == ValueType::code8    ? Depth::bits8
                  : type == ValueType::code16 ? Depth::bits16
                                              : Depth::floating;
  if (settings.contains("transfer")) request.transfer = parse_out_transfer(settings.at("transfer"));
  OutputFormat format = output_format(request, capture);
  format.type = type;
  if (settings.contains("negative")) {
    if (!holds_codes(type)) throw LightIsKept("the array");
    format.negative = negative_light(settings.at("negative"));
  }
  return format;
}

py::dict figures_of(const ExposedPicture& exposed) {
  const ExposureFigures& figures = exposed.figures;
  py::dict plan;
  plan["samples"] = figures.timeline.sample_count();
  plan["live_samples"] = figures.live_samples;
  plan["samples_read"] = py::make_tuple(figures.read.first, figures.read.last);
  plan["blocks_read"] = figures.blocks_read;
  plan["blocks"] = figures.block_count ? py::cast(*figures.block_count) : py::none();
  plan["table_bytes"] = figures.table_bytes;
  plan["map_bytes"] = figures.map_bytes;
  plan["functions"] = functions_of_plan(figures);
  const RenderStatistics& took = exposed.statistics;
  py::dict statistics;
  statistics["read_ms"] = took.read_ms;
  statistics["expose_ms"] = took.is_timed ? py::cast(took.expose_ms) : py::none();
  statistics["develop_ms"] = took.is_timed ? py::cast(took.develop_ms) : py::none();
  statistics["payload_bytes"] = took.payload_bytes;
  statistics["device_bytes"] = took.device_bytes;
  statistics["blocks"] = took.blocks;
  statistics["launches"] = took.launches;
  py::dict told;
  told["precision"] = to_text(exposed.precision);
  told["error_bound"] = bound_of(exposed);
  told["saturated"] = holds_codes(exposed.output.type)
                          ? py::object(py::make_tuple(exposed.saturation.below, exposed.saturation.above))
                          : py::none();
  told["plan"] = std::move(plan);
  told["statistics"] = std::move(statistics);
  told["warnings"] = exposed.warnings;
  return told;
}

void bind_rendering(py::module_& module) {
  py::class_<AskedExposure>(module, "Exposure")
      .def(py::init([](std::optional<HeldFunctions> functions, std::optional<HeldMask> mask,
                       Settings settings, const std::optional<DelayTimes>& delays_ns) {
             auto delay = delay_of(delays_ns, settings);
             return AskedExposure{std::move(functions), std::move(mask), std::move(settings),
                                  std::move(delay)};
           }),
           py::arg("functions"), py::arg("mask"), py::arg("settings"), py::arg("delays_ns"));
  module.def("render", &render, py::arg("capture"), py::arg("exposure"), py::arg("output"), py::arg("region"),
             py::arg("precision"));
}

}  // namespace nutik::python
