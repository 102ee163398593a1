// Pictures, which NumPy looks at where they lie. Exposures: what is asked for, how light came about, their figures.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/light_codes.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "media/writers/picture_writer.hpp"
#include "parts.hpp"
#include "session/output_check.hpp"
#include "session/requests/output_request.hpp"

namespace nutik::python {

py::dtype dtype_of(ValueType type) {
  return py::dtype(type == ValueType::code8 ? "u1" : type == ValueType::code16 ? "u2"
                   : type == ValueType::light32 ? "f4" : "f8");
}

Axes axes_of(const Shape& shape, Axes first) {
  first.insert(first.end(), {static_cast<py::ssize_t>(shape.height), static_cast<py::ssize_t>(shape.width)});
  if (shape.channels > 1) first.push_back(static_cast<py::ssize_t>(shape.channels));
  return first;
}

py::array view_of(const py::dtype& type, Axes shape, const void* values, py::handle owner) {
  py::array view(type, std::move(shape), values, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

namespace {

py::array values(const py::object& self) {
  const Picture& picture = self.cast<const HeldPicture&>().picture;
  return view_of(dtype_of(picture.type), axes_of(picture.shape), picture.bytes.data(), self);
}

// Looks for Ctrl-C between the parts that are written.
void write(const HeldPicture& held, const std::string& path, const Settings& settings) {
  check_output(path, OutputKind::picture, {});
  const OutputRequest request = stated_options(CommandId::expose, settings).picture;
  check_quality(request, path);
  without_lock([&](const Stopping& stopping) {
    FileWishes wishes = file_wishes(request);
    wishes.check = [progress = stopping.progress()] { progress(0, 0); };
    write_picture(path, held.picture, {}, wishes);
  });
}

// Light as codes of screens, whose white is the light that the capture's curve has for it.
HeldPicture for_eyes(const HeldPicture& held) {
  const Picture& light = held.picture;
  const Transfer srgb = Transfer::srgb();
  Picture codes(light.shape, ValueType::code8, 255);
  codes.transfer = srgb;
  codes.primaries = light.primaries;
  codes.pixel_aspect = light.pixel_aspect;
  const LightCodes table(srgb, 255);
  const double white = held.figures.contains("reference_white") ? held.figures["reference_white"].cast<double>() : 1.0;
  for (std::uint64_t i = 0; i < light.shape.value_count(); ++i) {
    const double value = light.type == ValueType::light32 ? light.values<float>()[i] : light.values<double>()[i];
    codes.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(value > 0 ? table.code_of(value / white) : 0);
  }
  return {std::move(codes), {}};
}

// All that a picture is, for pickle.
using State = std::tuple<std::array<std::uint32_t, 3>, int, std::uint32_t, std::optional<std::string>, int,
                         std::array<std::int64_t, 2>, std::optional<std::int64_t>, py::dict, py::bytes>;

State state_of(const HeldPicture& held) {
  const Picture& picture = held.picture;
  const auto& [width, height, channels] = picture.shape;
  const auto transfer = picture.transfer ? std::optional(picture.transfer->text()) : std::nullopt;
  return {{width, height, channels}, static_cast<int>(picture.type), picture.white_code, transfer,
          static_cast<int>(picture.primaries), {picture.pixel_aspect.numerator, picture.pixel_aspect.denominator},
          picture.exposed_ns, held.figures,
          py::bytes(reinterpret_cast<const char*>(picture.bytes.data()), picture.bytes.size())};
}

HeldPicture unpickled(const State& state) {
  const auto& [sides, type, white, transfer, primaries, aspect, exposed_ns, figures, bytes] = state;
  Picture picture({sides[0], sides[1], sides[2]}, static_cast<ValueType>(type), white);
  if (transfer) picture.transfer = Transfer::parse(*transfer);
  picture.primaries = static_cast<Primaries>(primaries);
  picture.pixel_aspect = Rational::of(aspect[0], aspect[1]);
  picture.exposed_ns = exposed_ns;
  const std::string_view values(bytes);
  if (values.size() != picture.bytes.size()) throw InputError("a pickled picture has another size than it says");
  std::memcpy(picture.bytes.data(), values.data(), values.size());
  return {std::move(picture), figures};
}

py::dict fields_of(const UncertaintyTerm& term, const OutputFormat& output) {
  py::dict fields;
  for (const auto& [name, value] : term.fields(output))
    std::visit([&](const auto& each) { fields[py::str(std::string(name))] = py::cast(each); }, value);
  return fields;
}

py::dict fields_of(const Uncertainty& uncertainty, const OutputFormat& output) {
  py::list terms;
  for (const UncertaintyTerm& term : uncertainty.terms) terms.append(fields_of(term, output));
  return py::dict("scale"_a = uncertainty.scale, "terms"_a = terms, "bounds"_a = fields_of(uncertainty.bounds, output));
}

py::list functions_of_plan(const ExposureFigures& figures) {
  py::list functions;
  for (const PlannedFunction& planned : figures.functions) {
    const GainSummary& summary = planned.summary;
    functions.append(py::dict("tag"_a = planned.tag, "pixels"_a = planned.pixel_count,
        "live_ns"_a = py::make_tuple(summary.live.begin_ns, summary.live.end_ns),
        "samples"_a = exposed_samples(planned, figures.timeline).size(), "still_gain"_a = summary.still_gain(),
        "support_ns"_a = summary.support_ns, "integral_ns"_a = std::scalbn(summary.integral_ns, summary.exponent)));
  }
  return functions;
}

py::dict maps_of(std::vector<PictureLayer>& layers) {
  py::dict maps;
  for (PictureLayer& layer : layers) maps[py::str(layer.name)] = HeldPicture{std::move(layer.values), {}};
  return maps;
}

HeldPicture render(const OpenCapture& capture, const AskedExposure& asked, const Settings& output, bool bounds,
                   const py::object& progress) {
  OutputFormat format = output_of(output, capture.session->format());
  format.maps_bounds = bounds;
  ExposedPicture exposed = without_lock([&](const Stopping& stopping) {
    RenderControl control = asked.control;
    control.stop = stopping.stop;
    control.progress = stopping.progress();
    return capture.session->render(asked.request, format, control);
  }, progress);
  py::dict figures = figures_of(exposed);
  if (bounds) figures["bounds_maps"] = maps_of(exposed.bounds);
  return {std::move(exposed.picture), std::move(figures)};
}

// What differs from `asked` in `count` exposures: starts, lengths, functions, each a list of one or of all, or empty.
struct Differences {
  std::vector<std::string> starts, lengths;
  std::vector<FunctionSet> functions;

  [[nodiscard]] ExposureRequest of(ExposureRequest request, std::size_t number) const {
    const auto at = [&](const auto& list) { return list[list.size() == 1 ? 0 : number]; };
    if (!starts.empty()) request.start = StatedTime::parse(at(starts), "start");
    if (!lengths.empty()) std::get<PlainInterval>(request.gains).length = StatedTime::parse(at(lengths), "exposure");
    if (!functions.empty()) request.gains = Shared(at(functions));
    return request;
  }
};

// [count, height, width(, 3)], the bound of each picture's light (NaN of the reference), of codes how many pixels hold
// light below and above them, warnings with their first picture, of each tag the least still gain, of each picture its
// maps, if these are asked for, and what tells each one's uncertainty: a thousand of those take longer than pictures.
py::tuple render_many(const OpenCapture& capture, const AskedExposure& asked, std::size_t count,
                      std::vector<std::string> starts, std::vector<std::string> lengths,
                      std::vector<FunctionSet> functions, const Settings& output, bool bounds,
                      const py::object& progress) {
  Session& session = *capture.session;
  const Differences differences{std::move(starts), std::move(lengths), std::move(functions)};
  OutputFormat format = output_of(output, session.format());
  format.maps_bounds = bounds;
  Shape shape = capture.shape();
  if (const auto& only = asked.control.rectangle) shape = {only->width, only->height, shape.channels};
  py::array pictures(dtype_of(format.type), axes_of(shape, {static_cast<py::ssize_t>(count)}));
  auto* const bytes = static_cast<std::byte*>(pictures.mutable_data());
  std::vector<double> errors;
  std::vector<std::uint64_t> saturated;
  std::map<std::string, std::pair<std::size_t, std::size_t>> doubts;  // in which picture first, in how many
  std::map<std::uint8_t, double> still_gains;
  std::vector<std::vector<PictureLayer>> maps;
  std::vector<Uncertainty> uncertainties;
  without_lock([&](const Stopping& stopping) {
    RenderControl control = asked.control;
    control.stop = stopping.stop;
    std::vector<ExposureRequest> requests;
    for (std::size_t number = 0; number < count; ++number) requests.push_back(differences.of(asked.request, number));
    session.render_many(requests, format, control, [&, report = stopping.progress()](std::size_t number,
                                                                                     ExposedPicture exposed) {
      const auto& made = exposed.picture.bytes;
      std::memcpy(bytes + number * made.size(), made.data(), made.size());
      errors.push_back(exposed.choice ? exposed.choice->bound.worst.light : std::numeric_limits<double>::quiet_NaN());
      saturated.insert(saturated.end(), {exposed.saturation.below, exposed.saturation.above});
      for (const PlannedFunction& function : exposed.figures.functions) {
        const double still_gain = function.summary.still_gain();
        double& least = still_gains.try_emplace(function.tag, still_gain).first->second;
        least = std::min(least, still_gain);
      }
      for (const std::string& warning : exposed.warnings) ++doubts.try_emplace(warning, number, 0).first->second.second;
      if (bounds) maps.push_back(std::move(exposed.bounds));
      uncertainties.push_back(std::move(exposed.uncertainty));
      report(number + 1, count);
    });
  }, progress);
  std::vector<std::string> warnings;
  for (const auto& [text, where] : doubts) {
    const std::string others = where.second == 1 ? "" : nutik::format(" and {} more", where.second - 1);
    warnings.push_back(where.second == count ? text : nutik::format("picture {}{}: {}", where.first, others, text));
  }
  py::list held_maps;
  for (auto& layers : maps) held_maps.append(maps_of(layers));
  const py::cpp_function told([format, known = std::move(uncertainties)] {
    py::list all;
    for (const Uncertainty& each : known) all.append(fields_of(each, format));
    return all;
  });
  return py::make_tuple(pictures, array_of(errors), array_of(saturated, {static_cast<py::ssize_t>(count), 2}), warnings,
                        still_gains, held_maps, told);
}

// How the light of a pixel, or the mean of a mask value's pixels, came about, as arrays.
py::dict arrays_of(const TracedExposure& exposure, const Trace& trace) {
  const PlannedFunction& function = exposure.function_of(trace);
  return py::dict("tag"_a = function.tag, "share"_a = static_cast<double>(trace.share) / kWholeShare,
                  "pixels"_a = trace.pixel_count, "steps"_a = array_of(trace.steps),
                  "exposed"_a = array_of(std::vector(trace.light.begin(), trace.light.begin() + trace.channels)),
                  "support_ns"_a = function.summary.support_ns);
}

// Traces a pixel (x, y), or a mask value where there is none.
py::tuple trace(const OpenCapture& capture, const AskedExposure& asked,
                const std::optional<std::pair<std::uint32_t, std::uint32_t>>& pixel,
                std::optional<std::uint8_t> tag, const py::object& progress) {
  Session& session = *capture.session;
  const TracedExposure exposure = without_lock([&](const Stopping& stopping) {
    const Followed followed = pixel ? Followed(TracedPixel{pixel->first, pixel->second}) : TracedTag{tag.value_or(0)};
    return session.trace(asked.request, followed, stopping.progress());
  }, progress);
  py::list traces;
  for (const Trace& each : exposure.traces) traces.append(arrays_of(exposure, each));
  return py::make_tuple(traces, exposure.warnings);
}

// The time of each pixel in nanoseconds, [height, width].
using DelayTimes = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
DelayRequest delay_of(const DelayTimes& times_ns) {
  if (times_ns.ndim() != 2 || times_ns.size() == 0)
    throw UsageError("delay= is an array of two axes, the picture's height and its width, none of them empty");
  const auto height = static_cast<std::uint32_t>(times_ns.shape(0));
  const auto width = static_cast<std::uint32_t>(times_ns.shape(1));
  return DelayRequest::of_times(width, height, {times_ns.data(), std::size_t{width} * height});
}

}  // namespace

OutputFormat output_of(const Settings& settings, const CaptureFormat& capture) {
  Options options;
  for (const auto& [argument, word] : settings) {
    // That of a clip, `transfer` too, is known here.
    const Option* const option = argument == "transfer" ? option_of(CommandId::expose, "out-transfer")
                                                        : option_of_argument(CommandId::expose, argument);
    option->state(options, argument, {word});
  }
  return output_format(options.picture, capture);
}

py::object saturated_of(ValueType type, const Saturation& saturation) {
  if (!holds_codes(type)) return py::none();
  return py::make_tuple(saturation.below, saturation.above);
}

py::dict figures_of(const ExposedPicture& exposed) {
  const ExposureFigures& figures = exposed.figures;
  const RenderStatistics& took = exposed.statistics;
  const auto timed = [&](double ms) { return took.is_timed ? std::optional(ms) : std::nullopt; };
  const auto plan = py::dict("samples"_a = figures.timeline.sample_count(), "live_samples"_a = figures.live_samples,
      "samples_read"_a = py::make_tuple(figures.read.first, figures.read.last), "blocks_read"_a = figures.blocks_read,
      "blocks"_a = figures.block_count, "table_bytes"_a = figures.table_bytes, "map_bytes"_a = figures.map_bytes,
      "functions"_a = functions_of_plan(figures));
  const auto statistics = py::dict("read_ms"_a = took.read_ms, "expose_ms"_a = timed(took.expose_ms),
      "develop_ms"_a = timed(took.develop_ms), "payload_bytes"_a = took.payload_bytes,
      "device_bytes"_a = took.device_bytes, "blocks"_a = took.blocks, "launches"_a = took.launches);
  py::object bound = py::none();
  if (exposed.choice) {
    const PictureError& worst = exposed.choice->bound.worst;
    bound = py::dict("light"_a = worst.light, "steps"_a = worst.steps);
  }
  return py::dict("precision"_a = to_text(exposed.precision), "error_bound"_a = bound,
      "uncertainty"_a = fields_of(exposed.uncertainty, exposed.output),
      "saturated"_a = saturated_of(exposed.output.type, exposed.saturation), "plan"_a = plan,
      "statistics"_a = statistics, "warnings"_a = exposed.warnings,
      "reference_white"_a = figures.capture.transfer.reference_white());
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
  py::class_<HeldPicture>(module, "Picture")
      .def(py::init(&unpickled))
      .def("__reduce__",  // py::pickle() ends the process in protocols 0 and 1
           [](const py::object& held) {
             return py::make_tuple(py::type::of(held), py::make_tuple(state_of(held.cast<const HeldPicture&>())));
           })
      .def("values", &values)
      .def("write", &write, "path"_a, "settings"_a)
      .def("for_eyes", &for_eyes)
      .def_readonly("figures", &HeldPicture::figures);
  PYBIND11_NUMPY_DTYPE(TraceStep::Value, begin_light, end_light, integral_ns, sum_ns);
  PYBIND11_NUMPY_DTYPE(TraceStep, begin_ns, end_ns, begin_gain, end_gain, is_made, values);
  py::class_<AskedExposure>(module, "Exposure")
      .def(py::init([](const std::optional<FunctionSet>& functions, const std::optional<HeldMask>& mask,
                       const Settings& settings, const std::optional<DelayTimes>& delays_ns,
                       const std::optional<std::array<std::uint32_t, 4>>& region) {
             Options options = stated_options(CommandId::expose, settings);
             if (delays_ns) options.asked.delay = delay_of(*delays_ns);
             ExposureRequest request = exposure_without_gains(options);
             request.start = options.start.value_or(StatedTime());
             request.gains = PlainInterval{options.exposure.value_or(StatedTime()), stated_shutter(options)};
             if (functions) request.gains = Shared(*functions);
             if (mask) request.mask = Shared(MaskWithRegions(**mask));
             RenderControl control;
             control.precision = options.precision;
             control.strict = options.strict;
             if (region) control.rectangle = Rectangle{(*region)[0], (*region)[1], (*region)[2], (*region)[3]};
             return AskedExposure{std::move(request), control};
           }),
           "functions"_a, "mask"_a, "settings"_a, "delays_ns"_a, "region"_a);
  module.def("devices", &devices);
  module.def("render", &render, "capture"_a, "exposure"_a, "output"_a, "bounds"_a, "progress"_a);
  module.def("trace", &trace, "capture"_a, "exposure"_a, "pixel"_a, "tag"_a, "progress"_a);
  module.def("render_many", &render_many, "capture"_a, "exposure"_a, "count"_a, "starts"_a, "lengths"_a, "functions"_a,
             "output"_a, "bounds"_a, "progress"_a);
}

}  // namespace nutik::python
