// What the engine finds in a capture by itself: motion studies, plates, activity, and the numbers that make a picture
// as it is wished.
#include <pybind11/stl.h>

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "errors.hpp"
#include "features/activity/activity.hpp"
#include "features/plate/plate.hpp"
#include "features/solve/solving.hpp"
#include "features/study/study.hpp"
#include "parts.hpp"
#include "session/requests/output_request.hpp"
#include "working.hpp"

namespace nutik::python {
namespace {

using Moments = std::variant<std::uint32_t, std::vector<std::string>>;

StudyRequest study_request(const Settings& settings, const std::optional<Moments>& moments,
                           const std::vector<std::array<std::uint32_t, 4>>& regions) {
  const Options options = stated_options(CommandId::study, settings);
  StudyRequest request = options.study;
  request.by_codes = options.by;
  request.feather = options.feather;
  if (!moments) {
    request.moments = usual_moments(request.style);
  } else if (const auto* count = std::get_if<std::uint32_t>(&*moments)) {
    request.moments = *count;
  } else {
    std::vector<StatedTime> times;
    for (const std::string& time : std::get<std::vector<std::string>>(*moments))
      times.push_back(StatedTime::parse(time, "moments"));
    request.moments = std::move(times);
  }
  for (const auto& [x, y, width, height] : regions) request.regions.push_back({x, y, width, height});
  return request;
}

// A study of a capture as it is, whose pictures lie on each other.
py::dict study(const OpenCapture& capture, const Settings& settings,
               const std::optional<Moments>& moments,
               const std::vector<std::array<std::uint32_t, 4>>& regions, const Settings& output,
               const py::object& progress) {
  Session& session = *capture.session;
  const StudyRequest request = study_request(settings, moments, regions);
  const OutputFormat format = output_of(output, session.format());
  struct Made {
    Study study;
    std::optional<ExposedPicture> exposed;
    std::optional<MadePlate> plate;
  };
  Made made = without_lock([&](const Stopping& stopping) {
    const MemoryBudget& memory = session.devices().request().memory;
    tik::Reader& reader = session.capture();
    Made found{plan_study(reader, capture.name, request, memory, stopping.progress()), {}, {}};
    if (request.style == StudyStyle::clean) {
      found.plate = make_plate(reader, capture.name, {}, format, memory, stopping.progress());
      return found;
    }
    RenderControl control;
    control.stop = stopping.stop;
    found.exposed =
        session.render(study_exposure(found.study, request), format, control);
    return found;
  }, progress);
  py::dict told;
  told["moments"] = made.study.moments;
  told["functions"] = held_functions(made.study.functions);
  told["notes"] = made.study.notes;
  told["mask"] = made.plate ? py::none() : py::cast(HeldMask{Shared(std::move(made.study.regions.mask))});
  if (made.exposed) {
    py::dict figures = figures_of(*made.exposed);
    told["picture"] = HeldPicture{std::move(made.exposed->picture), std::move(figures)};
  } else {
    told["picture"] = HeldPicture{std::move(made.plate->picture), {}};
  }
  return told;
}

py::tuple plate(const OpenCapture& capture, std::optional<std::uint32_t> by, const Settings& output,
                const py::object& progress) {
  Session& session = *capture.session;
  const OutputFormat format = output_of(output, session.format());
  MadePlate made = without_lock([&](const Stopping& stopping) {
    // Few plates need all steps: those that were not taken are done at the end.
    const ReportedProgress report = stopping.progress();
    std::uint64_t last = 0;
    MadePlate found = make_plate(session.capture(), capture.name, {by}, format, session.devices().request().memory,
                                 [&](std::uint64_t done, std::uint64_t total) {
                                   last = total;
                                   report(done, total);
                                 });
    report(last, last);
    return found;
  }, progress);
  const Shape& shape = made.picture.shape;
  Mask uncertain = Mask::uniform(shape.width, shape.height, 0);
  paint(uncertain, made.uncertain, 1);
  const std::vector<py::ssize_t> axes{static_cast<py::ssize_t>(shape.height),
                                      static_cast<py::ssize_t>(shape.width)};
  py::dict figures;
  figures["saturated"] = holds_codes(format.type)
                             ? py::object(py::make_tuple(made.saturation.below, made.saturation.above))
                             : py::none();
  const bool is_noise_known = made.is_noise_known;
  return py::make_tuple(HeldPicture{std::move(made.picture), std::move(figures)},
                        array_of(uncertain.tags, axes).attr("astype")("bool"), is_noise_known);
}

py::object stretch_of(const Timeline& timeline, const std::optional<ActivityMoments>& moments,
                      bool quietest) {
  if (!moments) return py::none();
  const SampleRange& samples = (quietest ? moments->quietest : moments->busiest).samples;
  py::dict stretch;
  stretch["samples"] = py::make_tuple(samples.first, samples.last);
  stretch["times_ns"] =
      py::make_tuple(timeline.start_ns(samples.first), timeline.reach_end_ns(samples.last - 1));
  return stretch;
}

py::dict activity(const OpenCapture& capture, const std::optional<HeldMask>& mask,
                  std::optional<std::uint8_t> tag, std::uint32_t ignored_codes, bool counts_redrawn,
                  const py::object& progress) {
  Session& session = *capture.session;
  ActivityRequest request;
  if (mask) request.mask = mask->mask;
  request.tag = tag;
  request.ignored_codes = ignored_codes;
  request.counts_redrawn = counts_redrawn;
  const MeasuredActivity measured = without_lock(
      [&](const Stopping& stopping) { return measure_activity(session, request, stopping.progress()); },
      progress);
  const Shape& shape = session.format().shape;
  py::dict told;
  told["changed_pixels"] = array_of(measured.activity.changed_pixels());
  told["changes"] = array_of(measured.activity.changes(),
                             {static_cast<py::ssize_t>(shape.height), static_cast<py::ssize_t>(shape.width)});
  told["counted_pixels"] = measured.activity.pixel_count();
  told["redrawn"] = array_of(measured.redrawn);
  told["busiest"] = stretch_of(measured.timeline, measured.moments, false);
  told["quietest"] = stretch_of(measured.timeline, measured.moments, true);
  told["notes"] = note_texts(measured.notes(), Dialect::python);
  return told;
}

py::dict told_wish(const SolvedWish& wish, std::size_t channels) {
  const auto first = [&](const std::array<double, 3>& light) {
    return std::vector<double>(light.begin(), light.begin() + static_cast<std::ptrdiff_t>(channels));
  };
  py::dict told;
  told["wish"] = wish.text;
  told["wanted"] = first(wish.light.wanted);
  told["reached"] = first(wish.light.reached);
  told["missed"] = wish.missed;
  told["is_kept"] = wish.is_kept();
  return told;
}

py::dict solve(const OpenCapture& capture, const std::string& functions,
               const std::vector<std::string>& wishes, const std::vector<std::string>& free,
               const AskedExposure& asked, const std::optional<HeldMask>& regions, const py::object& progress) {
  SolveRequest request;
  for (const std::string& wish : wishes) request.wishes.push_back(StatedWish::parse(wish));
  TemplateInput input = read_template(functions, "the functions");
  request.functions = std::move(input.functions);
  for (const std::string& each : free) request.free.push_back(StatedFreedom::parse(each, request.functions));
  for (const std::string& time : request.functions.times) {
    if (std::ranges::none_of(request.free, [&](const StatedFreedom& each) { return each.name == time; })) {
      throw UsageError(
          format("{} stands for a time; say when it may be: free={{'{}': (0.6, 0.8)}}", time, time));
    }
  }
  AskedExposure exposure = asked;
  exposure.functions = held_functions(tags_of(request.functions));
  request.exposure = exposure_request(exposure);
  if (regions) request.marks = regions->mask;
  const SolvedExposure solved = without_lock([&](const Stopping& stopping) {
    return nutik::solve(*capture.session, capture.name, request, stopping.progress(), stopping.progress());
  }, progress);
  py::dict gains, times;
  for (std::size_t i = 0; i < request.functions.gains.size(); ++i)
    gains[py::str(request.functions.gains[i])] = solved.numbers.gains[i];
  for (std::size_t i = 0; i < request.functions.times.size(); ++i)
    times[py::str(request.functions.times[i])] = solved.numbers.times_ns[i];
  const std::size_t channels = capture.session->format().shape.channels;
  py::list kept;
  for (const SolvedWish& wish : solved.wishes) kept.append(told_wish(wish, channels));
  std::vector<std::string> untold;
  for (const std::size_t gain : solved.untold) untold.push_back(request.functions.gains[gain]);
  std::vector<std::string> warnings = solved.warnings;
  if (!input.warnings.empty()) warnings.insert(warnings.begin(), input.warnings);
  py::dict told;
  told["text"] = solved.text;
  told["gains"] = std::move(gains);
  told["times_ns"] = std::move(times);
  told["wishes"] = std::move(kept);
  told["untold"] = untold;
  told["open_count"] = solved.open_count;
  told["tried"] = solved.tried;
  told["cost"] = solved.cost();
  told["is_kept"] = solved.is_kept();
  told["warnings"] = warnings;
  return told;
}

}  // namespace

void bind_studies(py::module_& module) {
  module.def("study", &study, py::arg("capture"), py::arg("settings"), py::arg("moments"), py::arg("regions"),
             py::arg("output"), py::arg("progress"));
  module.def("plate", &plate, py::arg("capture"), py::arg("by"), py::arg("output"), py::arg("progress"));
  module.def("activity", &activity, py::arg("capture"), py::arg("mask"), py::arg("tag"),
             py::arg("ignored_codes"), py::arg("counts_redrawn"), py::arg("progress"));
  module.def("solve", &solve, py::arg("capture"), py::arg("functions"), py::arg("wishes"), py::arg("free"),
             py::arg("exposure"), py::arg("regions"), py::arg("progress"));
}

}  // namespace nutik::python
