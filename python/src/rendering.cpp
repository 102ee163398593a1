// Exposures: what is asked for, the picture, and the plan's figures.
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "parts.hpp"
#include "session/requests/output_request.hpp"
#include "working.hpp"

namespace nutik::python {
namespace {

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

py::dict fields_of(const UncertaintyTerm& term, const OutputFormat& output) {
  py::dict fields;
  for (const auto& [name, value] : term.fields(output))
    std::visit([&](const auto& each) { fields[py::str(std::string(name))] = py::cast(each); }, value);
  return fields;
}

py::dict uncertainty_of(const ExposedPicture& exposed) {
  py::list terms;
  for (const UncertaintyTerm& term : exposed.uncertainty.terms) terms.append(fields_of(term, exposed.output));
  py::dict told;
  told["scale"] = exposed.uncertainty.scale;
  told["terms"] = std::move(terms);
  told["bounds"] = fields_of(exposed.uncertainty.bounds, exposed.output);
  return told;
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

using Region = std::optional<std::array<std::uint32_t, 4>>;

RenderControl control_of(const AskedExposure& asked, const Region& region, const std::optional<std::string>& precision) {
  RenderControl control;
  if (precision) control.precision = parse_precision(*precision);
  if (region) control.rectangle = Rectangle{(*region)[0], (*region)[1], (*region)[2], (*region)[3]};
  control.strict = asked.options.strict;
  return control;
}

HeldPicture render(const OpenCapture& capture, const AskedExposure& asked, const Settings& output, const Region& region,
                   const std::optional<std::string>& precision, bool bounds, const py::object& progress) {
  Session& session = *capture.session;
  const ExposureRequest request = exposure_request(asked);
  OutputFormat format = output_of(output, session.format());
  format.maps_bounds = bounds;
  RenderControl control = control_of(asked, region, precision);
  ExposedPicture exposed = without_lock([&](const Stopping& stopping) {
    control.stop = stopping.stop;
    control.progress = stopping.progress();
    return session.render(request, format, control);
  }, progress);
  py::dict figures = figures_of(exposed);
  if (bounds) {
    py::dict maps;
    for (PictureLayer& layer : exposed.bounds) maps[py::str(layer.name)] = HeldPicture{std::move(layer.values), {}};
    figures["bounds_maps"] = std::move(maps);
  }
  return {std::move(exposed.picture), std::move(figures)};
}

// Of `count` exposures what differs from `asked`: starts, lengths, functions, each a list of one or of all of them, or
// empty where it does not.
struct Differences {
  std::vector<std::string> starts, lengths;
  std::vector<HeldFunctions> functions;

  [[nodiscard]] ExposureRequest of(ExposureRequest request, std::size_t number) const {
    const auto at = [&](const auto& list) { return list[list.size() == 1 ? 0 : number]; };
    if (!starts.empty()) request.start = StatedTime::parse(at(starts), "start");
    if (!lengths.empty()) std::get<PlainInterval>(request.gains).length = StatedTime::parse(at(lengths), "exposure");
    if (!functions.empty()) request.gains = Shared(set_of(at(functions)));
    return request;
  }
};

// [count, height, width(, 3)], the bound of each picture's light (NaN of the reference), of codes how many pixels hold
// light below and above them, warnings, each once, and of each tag the least still gain.
py::tuple render_many(const OpenCapture& capture, const AskedExposure& asked, std::size_t count,
                      std::vector<std::string> starts, std::vector<std::string> lengths,
                      std::vector<HeldFunctions> functions, const Settings& output, const Region& region,
                      const std::optional<std::string>& precision, const py::object& progress) {
  Session& session = *capture.session;
  const Differences differences{std::move(starts), std::move(lengths), std::move(functions)};
  const ExposureRequest request = exposure_request(asked);
  const OutputFormat format = output_of(output, session.format());
  RenderControl control = control_of(asked, region, precision);
  Shape shape = session.format().shape;
  if (region) std::tie(shape.width, shape.height) = std::pair((*region)[2], (*region)[3]);
  std::vector<py::ssize_t> axes = axes_of(shape);
  axes.insert(axes.begin(), static_cast<py::ssize_t>(count));
  py::array pictures(dtype_of(format.type), axes);
  auto* const bytes = static_cast<std::byte*>(pictures.mutable_data());
  std::vector<double> bounds;
  std::vector<std::uint64_t> saturated;
  std::vector<std::string> warnings;
  std::map<std::uint8_t, double> still_gains;
  without_lock([&](const Stopping& stopping) {
    const ReportedProgress report = stopping.progress();
    control.stop = stopping.stop;
    std::vector<ExposureRequest> requests;
    for (std::size_t number = 0; number < count; ++number) requests.push_back(differences.of(request, number));
    session.render_many(requests, format, control, [&](std::size_t number, const Rendered& rendered,
                                                           std::span<const PlannedFunction> functions) {
      const auto& made = rendered.picture.bytes;
      std::memcpy(bytes + number * made.size(), made.data(), made.size());
      bounds.push_back(rendered.choice ? rendered.choice->bound.worst.light : std::numeric_limits<double>::quiet_NaN());
      saturated.insert(saturated.end(), {rendered.saturation.below, rendered.saturation.above});
      for (const PlannedFunction& function : functions) {
        const double still_gain = function.summary.still_gain();
        double& least = still_gains.try_emplace(function.tag, still_gain).first->second;
        least = std::min(least, still_gain);
      }
      for (const std::string& warning : rendered.warnings)
        if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(warning);
      report(number + 1, count);
    });
  }, progress);
  return py::make_tuple(pictures, array_of(bounds), array_of(saturated, {static_cast<py::ssize_t>(count), 2}), warnings,
                        still_gains);
}

// The time of each pixel in nanoseconds, [height, width].
using DelayTimes = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
DelayRequest delay_of(const DelayTimes& times_ns) {
  if (times_ns.ndim() != 2 || times_ns.size() == 0)
    throw UsageError("delay= is an array of two axes, the picture's height and its width, none of them empty");
  return DelayRequest::of_times(static_cast<std::uint32_t>(times_ns.shape(1)),
                                static_cast<std::uint32_t>(times_ns.shape(0)),
                                {times_ns.data(), static_cast<std::size_t>(times_ns.size())});
}

}  // namespace

ExposureRequest exposure_request(const AskedExposure& asked) {
  ExposureRequest request = weighed_exposure(asked.options);
  request.start = asked.options.start.value_or(StatedTime());
  if (asked.functions) {
    request.gains = Shared(set_of(*asked.functions));
  } else {
    request.gains = PlainInterval{asked.options.exposure.value(), stated_shutter(asked.options)};
  }
  if (asked.mask) request.mask = Shared(MaskWithRegions(*asked.mask->mask));
  return request;
}

OutputFormat output_of(const Settings& settings, const CaptureFormat& capture) {
  const ValueType type = value_type(settings.at("dtype"));
  Options options;
  for (const auto& [argument, option] : {std::pair("transfer", "out-transfer"), std::pair("negative", "negative")}) {
    if (const auto stated = settings.find(argument); stated != settings.end())
      option_of(CommandId::expose, option)->state(options, argument, {stated->second});
  }
  OutputRequest request = options.picture;
  if (request.negative && !holds_codes(type))
    throw UsageError(Advice{"`negative` says what codes make of light below 0, and an array of light keeps it; leave it out"});
  request.depth = type == ValueType::code8    ? Depth::bits8
                  : type == ValueType::code16 ? Depth::bits16
                                              : Depth::floating;
  const auto negative = std::exchange(request.negative, std::nullopt);
  OutputFormat format = output_format(request, capture);
  format.type = type;
  format.negative = negative.value_or(format.negative);
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
  told["uncertainty"] = uncertainty_of(exposed);
  told["saturated"] = holds_codes(exposed.output.type)
                          ? py::object(py::make_tuple(exposed.saturation.below, exposed.saturation.above))
                          : py::none();
  told["plan"] = std::move(plan);
  told["statistics"] = std::move(statistics);
  told["warnings"] = exposed.warnings;
  told["reference_white"] = figures.capture.transfer.reference_white();
  return told;
}

// Those of list_devices(), in its order.
py::list devices() {
  py::list told;
  for (const DeviceInfo& info : without_lock([](const Stopping&) { return list_devices(); })) {
    std::vector<std::string> precisions;
    for (const Precision precision : precisions_of(info)) precisions.push_back(to_text(precision));
    told.append(py::make_tuple(info.name, info.platform, info.driver_version, to_text(info.kind), info.compute_units,
                               info.memory_bytes, py::tuple(py::cast(precisions))));
  }
  return told;
}

void bind_rendering(py::module_& module) {
  py::class_<AskedExposure>(module, "Exposure")
      .def(py::init([](std::optional<HeldFunctions> functions, std::optional<HeldMask> mask,
                       const Settings& settings, const std::optional<DelayTimes>& delays_ns) {
             Options options = stated_options(CommandId::expose, settings);
             if (delays_ns) options.delay = delay_of(*delays_ns);
             return AskedExposure{std::move(functions), std::move(mask), std::move(options)};
           }),
           py::arg("functions"), py::arg("mask"), py::arg("settings"), py::arg("delays_ns"));
  module.def("devices", &devices);
  module.def("render", &render, py::arg("capture"), py::arg("exposure"), py::arg("output"), py::arg("region"),
             py::arg("precision"), py::arg("bounds"), py::arg("progress"));
  module.def("render_many", &render_many, py::arg("capture"), py::arg("exposure"), py::arg("count"), py::arg("starts"),
             py::arg("lengths"), py::arg("functions"), py::arg("output"), py::arg("region"), py::arg("precision"),
             py::arg("progress"));
}

}  // namespace nutik::python
