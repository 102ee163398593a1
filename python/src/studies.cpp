// What the engine finds in a capture by itself: motion studies, plates, activity, and the numbers that make a picture
// as it is wished.
#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/activity/activity.hpp"
#include "features/plate/plate.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "features/solve/solving.hpp"
#include "features/study/study.hpp"
#include "parts.hpp"

namespace nutik::python {
namespace {

// A study of a capture as it is, whose pictures lie on each other; `regions` as words.
py::dict study(const OpenCapture& capture, const Settings& settings, const std::vector<std::string>& regions,
               const Settings& output, const py::object& progress) {
  Session& session = *capture.session;
  Options options = stated_options(CommandId::study, settings);
  for (const std::string& region : regions) option_of(CommandId::study, "region")->state(options, "regions", {region});
  const StudyRequest request = study_request(options);
  const OutputFormat format = output_of(output, session.format());
  std::optional<ExposedPicture> exposed;
  Study study = without_lock([&](const Stopping& stopping) {
    Study planned = plan_study(session.capture(), capture.name, request, session.devices().request().memory,
                               stopping.progress());
    if (request.style == StudyStyle::clean) return planned;  // its picture is the background
    RenderControl control;
    control.stop = stopping.stop;
    exposed = session.render(study_exposure(planned, request), format, control);
    return planned;
  }, progress);
  py::dict told("moments"_a = study.moments, "functions"_a = study.functions, "notes"_a = study.notes);
  if (exposed) {
    told["mask"] = HeldMask(std::move(study.regions.mask));
    told["picture"] = HeldPicture{std::move(exposed->picture), figures_of(*exposed)};
  }
  return told;
}

py::tuple plate(const OpenCapture& capture, std::optional<std::uint32_t> by, const Settings& output,
                const py::object& progress) {
  Session& session = *capture.session;
  const OutputFormat format = output_of(output, session.format());
  MadePlate made = without_lock([&](const Stopping& stopping) {
    return make_plate(session.capture(), capture.name, {by}, format, session.devices().request().memory,
                      stopping.progress());
  }, progress);
  const Shape& shape = made.picture.shape;
  Mask uncertain = Mask::uniform(shape.width, shape.height, 0);
  paint(uncertain, made.uncertain, 1);
  const auto figures = py::dict("saturated"_a = saturated_of(format.type, made.saturation));
  return py::make_tuple(HeldPicture{std::move(made.picture), figures}, HeldMask(std::move(uncertain)),
                        made.is_noise_known);
}

py::object stretch_of(const Timeline& timeline, const std::optional<ActivityMoments>& moments, bool quietest) {
  if (!moments) return py::none();
  const SampleRange& samples = (quietest ? moments->quietest : moments->busiest).samples;
  const auto times_ns = py::make_tuple(timeline.start_ns(samples.first), timeline.reach_end_ns(samples.last - 1));
  return py::dict("samples"_a = py::make_tuple(samples.first, samples.last), "times_ns"_a = times_ns);
}

py::dict activity(const OpenCapture& capture, const std::optional<HeldMask>& mask, std::optional<std::uint8_t> tag,
                  std::uint32_t ignored_codes, bool counts_redrawn, const py::object& progress) {
  Session& session = *capture.session;
  ActivityRequest request;
  if (mask) request.mask = *mask;
  request.tag = tag;
  request.ignored_codes = ignored_codes;
  request.counts_redrawn = counts_redrawn;
  const MeasuredActivity measured = without_lock(
      [&](const Stopping& stopping) { return measure_activity(session, request, stopping.progress()); }, progress);
  const Shape& shape = capture.shape();
  return py::dict("changed_pixels"_a = array_of(measured.activity.changed_pixels()),
      "changes"_a = array_of(measured.activity.changes(), axes_of({shape.width, shape.height, 1})),
      "counted_pixels"_a = measured.activity.pixel_count(), "redrawn"_a = array_of(measured.redrawn),
      "busiest"_a = stretch_of(measured.timeline, measured.moments, false),
      "quietest"_a = stretch_of(measured.timeline, measured.moments, true),
      "notes"_a = note_texts(measured.notes(), Dialect::python));
}

py::dict told_wish(const SolvedWish& wish, std::size_t channels) {
  const auto first = [&](const std::array<double, 3>& light) {
    return std::vector<double>(light.begin(), light.begin() + static_cast<std::ptrdiff_t>(channels));
  };
  return py::dict("wish"_a = wish.text, "wanted"_a = first(wish.light.wanted),
                  "reached"_a = first(wish.light.reached), "missed"_a = wish.missed, "is_kept"_a = wish.is_kept());
}

py::dict solve(const OpenCapture& capture, const std::string& functions, const std::vector<std::string>& wishes,
               const std::vector<std::string>& free, const AskedExposure& asked, const std::optional<HeldMask>& regions,
               const py::object& progress) {
  SolveRequest request;
  for (const std::string& wish : wishes) request.wishes.push_back(StatedWish::parse(wish));
  TemplateInput input = read_template(functions, "the functions");
  request.functions = std::move(input.functions);
  for (const std::string& each : free) request.free.push_back(StatedFreedom::parse(each, request.functions));
  for (const std::string& time : request.functions.times) {
    if (std::ranges::none_of(request.free, [&](const StatedFreedom& each) { return each.name == time; }))
      throw UsageError(format("{} stands for a time; say when it may be: free={{'{}': (0.6, 0.8)}}", time, time));
  }
  request.exposure = asked.request;
  request.exposure.gains = Shared(tags_of(request.functions));
  request.marks = regions;
  const SolvedExposure solved = without_lock([&](const Stopping& stopping) {
    return nutik::solve(*capture.session, capture.name, request, stopping.progress(), stopping.progress());
  }, progress);
  const auto named = [](const std::vector<std::string>& names, const auto& numbers) {
    py::dict found;
    for (std::size_t i = 0; i < names.size(); ++i) found[py::str(names[i])] = numbers[i];
    return found;
  };
  py::list kept;
  for (const SolvedWish& wish : solved.wishes) kept.append(told_wish(wish, capture.shape().channels));
  std::vector<std::string> untold;
  for (const std::size_t gain : solved.untold) untold.push_back(request.functions.gains[gain]);
  std::vector<std::string> warnings = solved.warnings;
  if (!input.warnings.empty()) warnings.insert(warnings.begin(), input.warnings);
  return py::dict("text"_a = solved.text, "gains"_a = named(request.functions.gains, solved.numbers.gains),
                  "times_ns"_a = named(request.functions.times, solved.numbers.times_ns), "wishes"_a = kept,
                  "untold"_a = untold, "at_ends"_a = solved.at_ends, "open_count"_a = solved.open_count, "tried"_a = solved.tried,
                  "cost"_a = solved.cost(), "is_kept"_a = solved.is_kept(), "warnings"_a = warnings);
}

}  // namespace

void bind_studies(py::module_& module) {
  module.def("study", &study, "capture"_a, "settings"_a, "regions"_a, "output"_a, "progress"_a);
  module.def("plate", &plate, "capture"_a, "by"_a, "output"_a, "progress"_a);
  module.def("activity", &activity, "capture"_a, "mask"_a, "tag"_a, "ignored_codes"_a, "counts_redrawn"_a,
             "progress"_a);
  module.def("solve", &solve, "capture"_a, "functions"_a, "wishes"_a, "free"_a, "exposure"_a, "regions"_a,
             "progress"_a);
}

}  // namespace nutik::python
