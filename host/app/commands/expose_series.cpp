#include "app/commands/expose_series.hpp"

#include <filesystem>
#include <optional>
#include <set>

#include "app/commands/opened_session.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/stopwatch.hpp"
#include "app/requests/computing_words.hpp"
#include "app/requests/exposure_words.hpp"
#include "app/requests/output_words.hpp"
#include "app/requests/recipe_words.hpp"
#include "app/text/message_text.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/picture_queue.hpp"
#include "session/pictures.hpp"
#include "session/size_text.hpp"
#include "system/channel.hpp"

namespace nutik::app {
namespace {

namespace fs = std::filesystem;

// Where each picture goes; numbers count from 0, as pictures of a clip do.
class PictureNames {
 public:
  explicit PictureNames(const fs::path& pattern) : folder_(pattern.parent_path()) {
    const auto name = NumberedName::parse(pattern.filename().string());
    if (!name) {
      throw UsageError(
          format("a series needs a number in its pictures' name, as in {}; {} would be written again and "
                 "again",
                 (folder_ / (pattern.stem().string() + "-%03d" + pattern.extension().string())).string(),
                 pattern.string()));
    }
    name_ = *name;
  }

  [[nodiscard]] fs::path operator[](std::uint64_t k) const { return folder_ / name_.with(k); }

 private:
  fs::path folder_;
  NumberedName name_;
};

// Prints a warning that was not printed before: what is said of one exposure is often said of all.
class Warnings {
 public:
  void print(const fs::path& picture, const std::string& text) {
    if (said_.insert(text).second) print_warning(format("{}: {}", picture.string(), text));
  }

 private:
  std::set<std::string> said_;
};

}  // namespace

int expose_series(const Options& options) {
  const auto stated = stated_output(options.output, options.operands, "expose");
  const std::string& input = options.operands.front();
  ExposureRequest request = exposure_request(options);
  const SeriesRequest series = series_request(options);
  const PictureNames names(
      stated.value_or(sequence_name(input) + "-" + exposure_label(options) + "-%04d.png"));
  const std::vector<std::string> inputs = input_files(options);
  check_output(names[0], OutputKind::picture, inputs);  // before a clip is read
  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  PictureRecipe recipe(recipe_sources(options));
  Session session = open_session(input, options, devices);
  const std::vector<StatedTime> starts = starts_of(series, request, session.timeline());
  for (std::uint64_t k = 1; k < starts.size(); ++k) check_output(names[k], OutputKind::picture, inputs);
  const OutputFormat format_of_all = output_format(output_request(options), names[0], session.format());

  const Stopwatch stopwatch;
  Progress progress("exposing", starts.size(), options.quiet);
  Warnings warnings;
  Channel<std::string> failures(starts.size());  // of pictures that could not be written
  PictureQueue pictures([&](std::size_t, const Error& error) { failures.push(message_text(error)); });
  std::optional<ExposureFigures> first;
  ExposureTally tally;
  for (std::uint64_t k = 0; k < starts.size(); ++k) {
    progress.show(k);
    request.start = starts[k];
    ExposedPicture exposed = session.render(request, format_of_all);
    tally.add(exposed);
    for (const std::string& warning : exposure_warnings(exposed)) warnings.print(names[k], warning);
    pictures.push(k, names[k], std::move(exposed.picture),
                  recipe.text(tally.precision(), {{{"start", starts[k].text()}}, {}}));
    if (k == 0) first = std::move(exposed.figures);
  }
  pictures.finish();
  failures.close();
  if (const auto failure = failures.pop()) throw OutputError(*failure);
  if (options.json) {
    Json json{{"pictures", Json::array()}};
    for (std::uint64_t k = 0; k < starts.size(); ++k) {
      json["pictures"].push_back({{"picture", names[k].string()}, {"start", starts[k].text()}});
    }
    add_shape(json, session.format().shape);
    json["functions"] = functions_json(*first);
    add_saturation(json, tally.saturation(), format_of_all.type);
    add_rendering(json, session, tally, stopwatch);
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, names[0])) return 0;

  const double seconds = stopwatch.seconds();
  print_line(format("{} … {}: {} exposures every {}, {}{}{}, {:.1f} exposures a second, {:.2f} s on {}",
                    names[0].string(), names[starts.size() - 1].filename().string(), starts.size(),
                    series.every.text(), shape_text(session.format().shape),
                    still_gains_text(*first, request.is_plain()),
                    saturation_text(tally.saturation(), format_of_all.type),
                    static_cast<double>(starts.size()) / seconds, seconds, devices->renderer().name()));
  if (options.verbose) print_line("first " + plan_text(*first));
  print_details(options, tally, source_lines(session));
  return 0;
}

}  // namespace nutik::app
