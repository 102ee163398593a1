#include <algorithm>
#include <array>
#include <optional>

#include "app/commands/commands.hpp"
#include "app/input/exposure_request.hpp"
#include "app/input/opened_capture.hpp"
#include "app/input/sheet_exposures.hpp"
#include "app/input/sweep_values.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/output/picture_recipe.hpp"
#include "app/output/progress.hpp"
#include "app/output/shared_warnings.hpp"
#include "app/output/stopwatch.hpp"
#include "app/output/swept_recipe.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/numbered_name.hpp"
#include "media/picture_writer.hpp"
#include "session/size_text.hpp"

namespace nutik::app {
namespace {

constexpr const char* kNoRecipe =
    "it carries no recipe: neither a plain interval in the capture nor a function file, which has no jumps, "
    "says its gains";

// One picture of the sweep: the number of its value in each range.
using Combination = std::vector<std::uint64_t>;

// The first range runs fastest.
std::vector<Combination> combinations_of(const std::vector<SweepRange>& ranges) {
  std::vector<Combination> combinations{{}};
  for (auto range = ranges.rbegin(); range != ranges.rend(); ++range) {
    std::vector<Combination> longer;
    for (const Combination& combination : combinations) {
      for (std::uint64_t number = 0; number < range->count(); ++number) {
        longer.push_back(combination);
        longer.back().insert(longer.back().begin(), number);
      }
    }
    combinations = std::move(longer);
  }
  return combinations;
}

std::string label_of(const std::vector<SweepRange>& ranges, const Combination& combination) {
  std::string label;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    label += (i == 0 ? "" : ", ") + ranges[i].label(combination[i]);
  }
  return label;
}

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
  const std::vector<SweepRange> ranges = sweep_ranges(options);
  const std::vector<Combination> combinations = combinations_of(ranges);
  sheet::SheetWishes wishes = sheet_wishes(options);
  if (ranges.size() == 2) {
    if (wishes.columns)
      throw UsageError("two ranges make rows and columns by themselves; leave out --columns");
    wishes.columns = static_cast<std::uint32_t>(ranges.front().count());
  }
  if (options.operands.empty()) throw UsageError("an input is missing; see nutik-cl sweep --help");
  ExposureRequest request = ExposureRequest::from(options);
  const std::filesystem::path output = sheet_output(options, "sweep", request.label() + "-sweep");
  const std::vector<std::string> inputs = input_files(options);
  check_sheet_output(output, inputs);
  const std::vector<std::filesystem::path> singles = single_names(options, combinations.size(), inputs);

  OpenedCapture opened(options.operands.front(), options);
  tik::Reader& capture = opened.reader();
  const Timeline& timeline = capture.timeline();
  const Shape& shape = capture.format().shape;
  for (const std::filesystem::path& single : singles) {
    static_cast<void>(value_type_for(single, std::nullopt, ValueType::code8, shape.channels));
  }
  const FunctionSet functions = request.functions(timeline);
  const sheet::SheetLayout layout =
      sheet::lay_out(shape, static_cast<std::uint32_t>(combinations.size()), wishes);
  sheet::ContactSheet sheet(
      layout, format("{}: {}, {}", std::filesystem::path(options.operands.front()).filename().string(),
                     request.label(), counted(combinations.size(), "picture")));
  SheetExposures exposing(options, capture, request.mask(shape), request.plan_options());
  std::optional<PictureRecipe> recipe;  // of single pictures
  if (!singles.empty() && !options.no_recipe) recipe.emplace(options);
  SharedWarnings warnings;
  {
    Progress progress("exposing", combinations.size(), options.quiet);
    for (std::size_t i = 0; i < combinations.size(); ++i) {
      progress.show(i);
      FunctionSet changed = functions;
      for (std::size_t r = 0; r < ranges.size(); ++r)
        changed = varied(changed, ranges[r], combinations[i][r], timeline);
      const std::string label = label_of(ranges, combinations[i]);
      const Exposed exposed = exposing.expose(changed);
      warnings.add(label, exposure_warnings(exposed));
      sheet.add(label, exposed.picture, exposing.transfer());
      if (singles.empty()) continue;
      std::string text;
      if (recipe) {
        const auto own = swept_recipe(changed, options, timeline, singles[i].stem().string() + ".fn");
        if (own) text = recipe->text(exposing.exposer().precision(), *own);
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
    for (std::size_t i = 0; i < combinations.size(); ++i) {
      Json picture;
      for (std::size_t r = 0; r < ranges.size(); ++r) {
        const Rational value = ranges[r].value(combinations[i][r]);
        if (ranges[r].parameter != SweepParameter::shift) {
          picture[key_of(ranges[r].parameter)] = value.value();
        } else if (ranges[r].unit_ns == 0) {
          picture["shift_samples"] = value.numerator;
        } else {
          picture["shift_ns"] = value.numerator;
        }
      }
      if (!singles.empty()) picture["file"] = singles[i].string();
      json["pictures"].push_back(std::move(picture));
    }
    add_saturation(json, exposing.saturation(), exposing.type());
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;
  print_line(format("{}: {}, {}, {}{}, {:.2f} s on {}", output.string(),
                    counted(combinations.size(), "picture"), counted(layout.columns, "column"),
                    counted(layout.rows, "row"), saturation_text(exposing.saturation(), exposing.type()),
                    stopwatch.seconds(), exposing.exposer().renderer_name()));
  print_details(options, exposing.exposer(), opened.notes());
  return 0;
}

}  // namespace nutik::app
