#include <algorithm>
#include <iterator>
#include <utility>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "features/series/series_making.hpp"
#include "media/events/event_clip.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/clips/clip_source.hpp"
#include "session/requests/stated_moments.hpp"
#include "session/text/number_text.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {

// A series (series.cpp).
int run_series(const Options& options);

// A plain interval sees no picture but those that it reaches: samples are made between these and their neighbours
// alone. The recipe has what was stated, as those of series and films have.
static void make_between_seen(Options& options, const ExposureRequest& request) {
  const std::string& clip = options.operands.front();
  const auto* plain = std::get_if<PlainInterval>(&request.gains);
  if (!options.source.between || plain == nullptr || request.delay || is_standard_input(clip) ||
      is_event_recording(clip) || is_tik(clip))
    return;
  BetweenRequest between = *options.source.between;
  if (between.first != 0 || between.last != UINT64_MAX) return;
  SourceRequest filmed;
  filmed.path = clip;
  filmed.clip = options.source.clip;
  filmed.shutter_angle = options.source.shutter_angle;
  try {
    const Timeline timeline = known_timeline(filmed, memory_budget(options));
    const auto [start_ns, end_ns] = plain_interval(request.start, plain->length, timeline);
    const SampleRange seen = timeline.samples_reaching(start_ns, end_ns);
    if (seen.empty()) return;
    between.first = seen.first - std::min<std::uint64_t>(seen.first, 1);
    between.last = std::min(seen.last, timeline.sample_count() - 1);
    if (between.first == between.last) return;
    options.source.between = between;
  } catch (const InputError&) {
    return;  // not known before it is decoded
  }
}

int run_expose(const Options& stated) {
  if (stated.every) return run_series(stated);
  Options options = stated;
  if (options.count) throw UsageError("--count goes with --every: a series needs both a step and a number");
  if (options.frames) throw UsageError("--frames chooses pictures of a series; add --every, or leave it out");
  ExposureTally tally;
  const std::filesystem::path output = output_name(options, "expose", "-" + exposure_label(options) + ".png");
  if (NumberedName::parse(output.filename().string()))
    throw UsageError(format("{} numbers the pictures of a series, and this is one: add --every, or name it without %",
                            output.string()));
  const ExposureRequest request = exposure_request(options);
  const std::vector<std::string> inputs = input_files(options);
  check_output(output, OutputKind::picture, inputs, replacing(options));
  const BoundsMaps maps(options, false, "a picture");
  make_between_seen(options, request);

  PictureRecipe recipe(recipe_sources(options));
  if (options.skip_existing) {
    require_recipes(options, output);
    if (is_made(output, stated_precision(options), maps.of(0),
                [&](const std::string& precision) { return recipe.text(precision); }))
      return tell_all_made(options, output, 1, "picture");
  }
  maps.check(0, inputs, output, replacing(options));
  Session session = open_session(options, {.reading = Reading::forward});
  RenderControl control;
  control.progress = progress_bar("exposing", options.quiet);
  const ExposedPicture exposed =
      session.render(request, output_format(options.picture, output, session.format()), control);
  control.progress = {};  // the bar is gone before anything is said
  tally.add(exposed);
  print_warnings(exposure_warnings(exposed));
  const std::string made = recipe.text(tally.precision(), {}, tally.error_bound(), maps.write(0, exposed));
  write_picture(output, exposed.picture, made, file_wishes(options.picture));

  const ExposureFigures& figures = exposed.figures;
  const Shape shape =
      written_shape(output, exposed.picture.shape, exposed.picture.pixel_aspect, file_wishes(options.picture));
  const std::uint64_t samples = figures.timeline.sample_count();
  Answer answer{{{"picture", output.string()}}};
  if (maps.are_asked()) answer.json["bounds_map"] = maps.of(0).string();
  tally.wrote(figures.capture, shape, output);
  answer.json.update(shape_json(shape));
  answer.json.update(
      {{"samples", samples}, {"live_samples", figures.live_samples}, {"functions", functions_json(figures)}});
  answer.line = format("{}: {}, {} of {} samples{}{}", output.string(), shape_text(shape),
                       figures.live_samples, samples, still_gains_text(figures, !options.functions),
                       codes_text(figures.capture, exposed.output));
  if (options.verbose) answer.details.push_back(plan_text(figures));
  tally.end(answer, session, options.verbose);
  answer.tell_source(session);
  std::ranges::move(std::exchange(answer.source, {}), std::back_inserter(answer.details));
  return tell(options, output, answer);
}

}  // namespace nutik::app
