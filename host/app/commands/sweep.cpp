#include <algorithm>
#include <array>
#include <optional>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/shared_warnings.hpp"
#include "app/output/sheet_exposures.hpp"
#include "app/output/stopwatch.hpp"
#include "app/requests/exposure_words.hpp"
#include "app/requests/recipe_words.hpp"
#include "app/requests/sweep_words.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "session/size_text.hpp"
#include "session/swept_recipe.hpp"

namespace nutik::app {
namespace {

constexpr const char* kNoRecipe =
    "it carries no recipe: neither a plain interval in the capture nor a function file, which has no jumps, "
    "says its gains";

// Names for the single pictures; empty where none are asked for.
std::vector<std::filesystem::path> single_names(const Options& options, std::size_t count,
                                                std::span<const std::string> inputs) {
  std::vector<std::filesystem::path> names;
  if (!options.each) return names;
  const std::filesystem::path pattern = *options.each;
  const auto numbered = NumberedName::parse(pattern.filename().string());
  if (!numbered) {
    throw UsageError(format("--each {} has no place for a number; write name%02d.png", *options.each));
  }
  for (std::size_t i = 0; i < count; ++i) {
    names.push_back(pattern.parent_path() / numbered->with(i));
    check_output(names.back(), OutputKind::picture, inputs);
  }
  return names;
}

const char* key_of(SweepParameter parameter) {
  switch (parameter) {
    case SweepParameter::shift: return "shift";
    case SweepParameter::gain: return "gain_factor";
    case SweepParameter::stretch: return "stretch_factor";
  }
  return "";
}

}  // namespace

int run_sweep(const Options& options) {
  const Stopwatch stopwatch;
  const SweepRequest sweep = sweep_request(options);
  const std::vector<SweepPoint> points = sweep.points();
  sheet::SheetWishes wishes = sheet_wishes(options);
  if (sweep.ranges.size() == 2) {
    if (wishes.columns)
      throw UsageError("two ranges make rows and columns by themselves; leave out --columns");
    wishes.columns = static_cast<std::uint32_t>(sweep.ranges.front().count());
  }
  if (options.operands.empty()) throw UsageError("an input is missing; see nutik-cl sweep --help");
  const ExposureRequest request = exposure_request(options);
  const std::filesystem::path output = sheet_output(options, "sweep", exposure_label(options) + "-sweep");
  const std::vector<std::string> inputs = input_files(options);
  check_sheet_output(output, inputs);
  const std::vector<std::filesystem::path> singles = single_names(options, points.size(), inputs);

  Session session = open_session(options.operands.front(), options);
  const Timeline& timeline = session.timeline();
  const Shape& shape = session.format().shape;
  for (const std::filesystem::path& single : singles) {
    static_cast<void>(value_type_for(single, std::nullopt, ValueType::code8, shape.channels));
  }
  const FunctionSet functions = functions_of(request, timeline);
  const sheet::SheetLayout layout = sheet::lay_out(shape, static_cast<std::uint32_t>(points.size()), wishes);
  sheet::ContactSheet sheet(
      layout, format("{}: {}, {}", std::filesystem::path(options.operands.front()).filename().string(),
                     exposure_label(options), counted(points.size(), "picture")));
  SheetExposures exposing(options, session, mask_of(request, shape), plan_options_of(request));
  PictureRecipe recipe(singles.empty() ? std::nullopt : recipe_sources(options));  // of single pictures
  SharedWarnings warnings;
  {
    Progress progress("exposing", points.size(), options.quiet);
    for (std::size_t i = 0; i < points.size(); ++i) {
      progress.show(i);
      const FunctionSet changed = sweep.varied(functions, points[i], timeline);
      const std::string label = sweep.label(points[i]);
      const ExposedPicture exposed = exposing.expose(changed);
      warnings.add(label, exposure_warnings(exposed));
      sheet.add(label, exposed.picture, exposing.transfer());
      if (singles.empty()) continue;
      std::string text;
      if (!options.no_recipe) {
        const auto own = swept_recipe(changed, request, timeline, singles[i].stem().string() + ".fn");
        if (own) text = recipe.text(exposing.tally().precision(), *own);
        if (!own) warnings.add(singles[i].string(), std::array{std::string(kNoRecipe)});
      }
      write_picture(singles[i], exposed.picture, text);
    }
  }
  warnings.print();
  write_picture(output, sheet.finished());

  if (options.json) {
    Json json{{"sheet", output.string()}, {"columns", layout.columns}, {"rows", layout.rows}};
    json["pictures"] = Json::array();
    for (std::size_t i = 0; i < points.size(); ++i) {
      Json picture;
      for (std::size_t r = 0; r < sweep.ranges.size(); ++r) {
        const Rational value = sweep.ranges[r].value(points[i][r]);
        if (sweep.ranges[r].parameter != SweepParameter::shift) {
          picture[key_of(sweep.ranges[r].parameter)] = value.value();
        } else if (sweep.ranges[r].counts_pictures) {
          picture["shift_samples"] = value.numerator;
        } else {
          picture["shift_ns"] = value.numerator;
        }
      }
      if (!singles.empty()) picture["file"] = singles[i].string();
      json["pictures"].push_back(std::move(picture));
    }
    add_saturation(json, exposing.tally().saturation(), exposing.type());
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;
  print_line(format("{}: {}, {}, {}{}, {:.2f} s on {}", output.string(), counted(points.size(), "picture"),
                    counted(layout.columns, "column"), counted(layout.rows, "row"),
                    saturation_text(exposing.tally().saturation(), exposing.type()), stopwatch.seconds(),
                    session.devices().renderer().name()));
  print_details(options, exposing.tally(), source_lines(session));
  return 0;
}

}  // namespace nutik::app
