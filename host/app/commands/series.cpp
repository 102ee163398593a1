// A series of exposures of one capture: `expose` with --every.
#include <optional>
#include <string>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/requests/requests.hpp"
#include "session/below/format.hpp"
#include "session/making/picture_queue.hpp"
#include "session/making/series_making.hpp"
#include "session/text/size_text.hpp"

namespace nutik::app {
int run_series(const Options& options) {
  const PictureNames names(output_name(options, "expose", "-" + exposure_label(options) + "-%04d.png"),
                           "a series");
  const ExposureRequest request = exposure_request(options);
  const SeriesRequest series = series_request(options);
  const std::vector<std::string> inputs = input_files(options);
  check_output(names[0], OutputKind::picture, inputs);  // before a clip is read
  PictureRecipe recipe(recipe_sources(options));
  const OutputRequest wishes = output_request(options);
  Session session = open_session(options, {.besides = PictureQueue::needs([&](const CaptureFormat& capture) {
                                             return output_format(wishes, names[0], capture).type;
                                           })});
  std::vector<SeriesPicture> pictures;
  for (StatedTime& start : starts_of(series, request, session.timeline())) {
    pictures.push_back({std::move(start), names[pictures.size()]});
    check_output(pictures.back().path, OutputKind::picture, inputs);
  }
  const OutputFormat output = output_format(wishes, names[0], session.format());

  ExposureTally tally;
  std::optional<ExposureFigures> first;
  {
    WarningsAtEnd warnings;
    make_series(session, request, pictures, output, file_wishes(wishes),
                progress_bar("exposing", options.quiet), [&](std::uint64_t k, ExposedPicture& exposed) {
                  tally.add(exposed);
                  warnings.add(pictures[k].path.string(), exposure_warnings(exposed));
                  if (k == 0) first = std::move(exposed.figures);
                  return recipe.text(tally.precision(), {{{"start", pictures[k].start.text()}}, {}});
                });
  }

  Answer answer{{{"pictures", Json::array()}}};
  for (const SeriesPicture& picture : pictures) {
    answer.json["pictures"].push_back({{"picture", picture.path.string()}, {"start", picture.start.text()}});
  }
  answer.json.update(shape_json(session.format().shape));
  answer.json["functions"] = functions_json(*first);
  answer.line = format("{} … {}: {} exposures every {}, {}{}{}", names[0].string(),
                       pictures.back().path.filename().string(), pictures.size(), series.every.text(),
                       shape_text(session.format().shape), still_gains_text(*first, request.is_plain()),
                       codes_text(first->capture, output));
  if (options.verbose) answer.details.push_back("first " + plan_text(*first));
  tally.end(answer, session, options.verbose,
            format(", {:.1f} exposures a second", static_cast<double>(pictures.size()) / tally.seconds()));
  answer.tell_source(session);
  return tell(options, names[0], answer);
}

}  // namespace nutik::app
