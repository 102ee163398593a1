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
    found.exposed = session.render(study_exposure(found.study, request), format, control);
    return found;
  }, progress);
  py::object mask = py::none();
  py::dict figures;
  if (made.exposed) figures = figures_of(*made.exposed);
  if (!made.plate) mask = py::cast(HeldMask(std::move(made.study.regions.mask)));
  Picture& picture = made.exposed ? made.exposed->picture : made.plate->picture;
  return py::dict("moments"_a = made.study.moments, "functions"_a = made.study.functions,
                  "notes"_a = made.study.notes, "mask"_a = mask,
                  "picture"_a = HeldPicture{std::move(picture), figures});
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
  py::array_t<bool> is_uncertain(axes_of({shape.width, shape.height, 1}));
  std::ranges::transform(uncertain.tags, is_uncertain.mutable_data(), [](std::uint8_t tag) { return tag != 0; });
  const auto figures = py::dict("saturated"_a = saturated_of(format.type, made.saturation));
  return py::make_tuple(HeldPicture{std::move(made.picture), figures}, is_uncertain, made.is_noise_known);
}

py::object stretch_of(const Timeline& timeline, const std::optional<ActivityMoments>& moments,
                      bool quietest) {
  if (!moments) return py::none();
  const SampleRange& samples = (quietest ? moments->quietest : moments->busiest).samples;
  const auto times_ns = py::make_tuple(timeline.start_ns(samples.first), timeline.reach_end_ns(samples.last - 1));
  return py::dict("samples"_a = py::make_tuple(samples.first, samples.last), "times_ns"_a = times_ns);
}

py::dict activity(const OpenCapture& capture, const std::optional<HeldMask>& mask,
                  std::optional<std::uint8_t> tag, std::uint32_t ignored_codes, bool counts_redrawn,
                  const py::object& progress) {
  Session& session = *capture.session;
  ActivityRequest request;
  if (mask) request.mask = *mask;
  request.tag = tag;
  request.ignored_codes = ignored_codes;
  request.counts_redrawn = counts_redrawn;
  const MeasuredActivity measured = without_lock(
      [&](const Stopping& stopping) { return measure_activity(session, request, stopping.progress()); }, progress);
  const Shape& shape = capture.shape();
  return py::dict(
      "changed_pixels"_a = array_of(measured.activity.changed_pixels()),
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
  request.exposure = asked.request;
  request.exposure.gains = Shared(tags_of(request.functions));
  request.marks = regions;
  const SolvedExposure solved = without_lock([&](const Stopping& stopping) {
    return nutik::solve(*capture.session, capture.name, request, stopping.progress(), stopping.progress());
  }, progress);
  py::dict gains, times;
  for (std::size_t i = 0; i < request.functions.gains.size(); ++i)
    gains[py::str(request.functions.gains[i])] = solved.numbers.gains[i];
  for (std::size_t i = 0; i < request.functions.times.size(); ++i)
    times[py::str(request.functions.times[i])] = solved.numbers.times_ns[i];
  py::list kept;
  for (const SolvedWish& wish : solved.wishes) kept.append(told_wish(wish, capture.shape().channels));
  std::vector<std::string> untold;
  for (const std::size_t gain : solved.untold) untold.push_back(request.functions.gains[gain]);
  std::vector<std::string> warnings = solved.warnings;
  if (!input.warnings.empty()) warnings.insert(warnings.begin(), input.warnings);
  return py::dict("text"_a = solved.text, "gains"_a = gains, "times_ns"_a = times, "wishes"_a = kept,
                  "untold"_a = untold, "open_count"_a = solved.open_count, "tried"_a = solved.tried,
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
