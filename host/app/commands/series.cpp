// A series of exposures of one capture: `expose` with --every.
#include <optional>
#include <string>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "features/series/picture_queue.hpp"
#include "features/series/series_making.hpp"
#include "session/text/number_text.hpp"

namespace nutik::app {
int run_series(const Options& options) {
  const PictureNames names(output_name(options, "expose", "-" + exposure_label(options) + "-%04d.png"),
                           "a series");
  const ExposureRequest request = exposure_request(options);
  const SeriesRequest series{*options.every, options.count, options.frames};
  const std::vector<std::string> inputs = input_files(options);
  check_output(names[0], OutputKind::picture, inputs, replacing(options));  // before a clip is read
  const BoundsMaps maps(options, true, "a series");
  if (options.skip_existing) require_recipes(options, names[0]);
  PictureRecipe recipe(recipe_sources(options));
  const OutputRequest wishes = options.picture;
  Session session = open_session(options, {.besides = PictureQueue::needs([&](const CaptureFormat& capture) {
                                             return output_format(wishes, names[0], capture).type;
                                           })});
  const auto own_recipe_of = [](const SeriesPicture& picture) {
    return OwnRecipe{{{"start", picture.start.text()}}, {}};
  };
  std::vector<SeriesPicture> pictures;
  const std::vector<StatedTime> starts = starts_of(series, request, session.timeline());
  for (const std::uint64_t k : chosen_numbers(series.numbers, starts.size(), "exposures", "series")) {
    pictures.push_back({starts[k], names[k], k});
    check_output(pictures.back().path, OutputKind::picture, inputs, replacing(options));
  }
  const std::size_t wanted = pictures.size();
  if (options.skip_existing) {
    std::erase_if(pictures, [&](const SeriesPicture& picture) {
      const auto recipe_of = [&](const std::string& precision) {
        return recipe.text(precision, own_recipe_of(picture));
      };
      return is_made(picture.path, stated_precision(options), maps.of(picture.number), recipe_of);
    });
    if (pictures.empty()) return tell_all_made(options, names[0], wanted, "exposure");
  }
  for (const SeriesPicture& picture : pictures)
    maps.check(picture.number, inputs, picture.path, replacing(options));
  const OutputFormat output = output_format(wishes, names[0], session.format());

  ExposureTally tally;
  std::optional<ExposureFigures> first;
  std::vector<Json> told;
  {
    WarningsAtEnd warnings;
    make_series(session, request, pictures, output, file_wishes(wishes),
                progress_bar("exposing", options.quiet, progress_lines(options)),
                [&](std::uint64_t k, ExposedPicture& exposed) {
                  tally.add(exposed);
                  warnings.add(pictures[k].path.string(), exposure_warnings(exposed));
                  const auto map = maps.write(pictures[k].number, exposed);
                  told.push_back(uncertainty_json(exposed.uncertainty, exposed.output));
                  if (k == 0) first = std::move(exposed.figures);
                  return recipe.text(tally.precision(), own_recipe_of(pictures[k]), tally.error_bound(), map);
                });
  }

  Answer answer{{{"pictures", Json::array()}}};
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    answer.json["pictures"].push_back({{"picture", pictures[k].path.string()},
                                       {"start", pictures[k].start.text()},
                                       {"start_ns", moment_ns(pictures[k].start, session.timeline())}});
    if (maps.are_asked()) answer.json["pictures"].back()["bounds_map"] = maps.of(pictures[k].number).string();
    answer.json["pictures"].back().update(told[k]);
  }
  const Shape shape =
      written_shape(names[0], session.format().shape, session.format().pixel_aspect, file_wishes(wishes));
  tally.wrote(session.format(), shape, names[0]);
  answer.json.update(shape_json(shape));
  answer.json["functions"] = functions_json(*first);
  const std::string last = pictures.size() == 1 ? "" : " … " + pictures.back().path.filename().string();
  answer.line = format("{}{}: {} every {}, {}{}{}", pictures.front().path.string(), last,
                       counted(pictures.size(), "exposure"), series.every.text(),
                       shape_text(shape), still_gains_text(*first, request.is_plain()),
                       codes_text(first->capture, output));
  answer.json["skipped"] = wanted - pictures.size();
  if (wanted > pictures.size())
    answer.line += format(", {} there already", counted(wanted - pictures.size(), "exposure"));
  if (options.verbose) answer.details.push_back("first " + plan_text(*first));
  tally.end(answer, session, options.verbose,
            format(", {:.1f} exposures a second", static_cast<double>(pictures.size()) / tally.seconds()));
  answer.tell_source(session);
  note_later(answer.notes, [&](std::uint64_t k) { return names[k]; }, starts.size());
  return tell(options, names[0], answer);
}

}  // namespace nutik::app
