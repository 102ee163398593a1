#include <filesystem>

#include "app/commands/commands.hpp"
#include "app/commands/expose_series.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/output_name.hpp"
#include "app/output/stopwatch.hpp"
#include "app/requests/computing_words.hpp"
#include "app/requests/exposure_words.hpp"
#include "app/requests/output_words.hpp"
#include "app/requests/recipe_words.hpp"
#include "app/text/timing_text.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "session/size_text.hpp"

namespace nutik::app {

int run_expose(const Options& options) {
  if (options.every) return expose_series(options);
  if (options.count) throw UsageError("--count goes with --every: a series needs both a step and a number");
  const Stopwatch stopwatch;
  const auto stated = stated_output(options.output, options.operands, "expose");
  const std::string& input = options.operands.front();
  const ExposureRequest request = exposure_request(options);
  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  const std::filesystem::path output = stated ? *stated : picture_name(input, exposure_label(options));
  check_output(output, OutputKind::picture, input_files(options));

  PictureRecipe recipe(recipe_sources(options));
  Session session = open_session(input, options, devices, Reading::forward);
  const ExposedPicture exposed =
      session.render(request, output_format(output_request(options), output, session.format()));
  ExposureTally tally;
  tally.add(exposed);
  for (const std::string& warning : exposure_warnings(exposed)) print_warning(warning);
  write_picture(output, exposed.picture, recipe.text(tally.precision()));
  const ExposureFigures& figures = exposed.figures;
  if (options.json) {
    Json json{{"picture", output.string()}};
    add_shape(json, exposed.picture.shape);
    json["samples"] = figures.timeline.sample_count();
    json["live_samples"] = figures.live_samples;
    json["functions"] = functions_json(figures);
    add_saturation(json, exposed.saturation, exposed.picture.type);
    add_rendering(json, session, tally, stopwatch);
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;

  print_line(format("{}: {}, {} of {} samples{}{}, {:.2f} s on {}", output.string(),
                    shape_text(figures.capture.shape), figures.live_samples, figures.timeline.sample_count(),
                    still_gains_text(figures, !options.functions),
                    saturation_text(exposed.saturation, exposed.picture.type), stopwatch.seconds(),
                    devices->renderer().name()));
  if (options.verbose) print_line(plan_text(figures));
  print_details(options, tally, {});
  if (session.is_clip()) {
    print_line(format("source: {}", timing_text(figures.timeline, session.source())));
    for (const std::string& line : note_lines(session.notes(), figures.timeline, session.source()))
      print_note(line);
  }
  return 0;
}

}  // namespace nutik::app
