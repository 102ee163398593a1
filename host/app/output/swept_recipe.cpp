#include "app/output/swept_recipe.hpp"

#include <algorithm>
#include <cmath>

#include "app/input/exposure_request.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_text.hpp"

namespace nutik::app {
namespace {

// Of functions that are normalized and brightened already.
const std::map<std::string, std::optional<std::string>> kAsItIs{
    {"gain", std::nullopt}, {"ev", std::nullopt}, {"normalize", std::nullopt}};

// The interval from the function's first point to its last, as bright as the function.
std::optional<OwnRecipe> plain_recipe(const FunctionSet& functions, Options options,
                                      const Timeline& timeline) {
  const auto points = functions.begin()->second.points();
  const std::int64_t start_ns = points.front().time_ns;
  options.start = TimeText::of_nanoseconds(start_ns).text();
  options.exposure = TimeText::of_nanoseconds(points.back().time_ns - start_ns).text();
  for (auto* member : {&options.gain, &options.ev, &options.normalize}) member->reset();
  try {
    const FunctionSet made = ExposureRequest::from(options).functions(timeline);
    const auto made_points = made.begin()->second.points();
    if (made_points.size() != points.size()) return std::nullopt;
    const auto strongest = std::ranges::max_element(
        made_points, {}, [](const ControlPoint& point) { return std::fabs(point.gain); });
    const double gain =
        points[static_cast<std::size_t>(strongest - made_points.begin())].gain / strongest->gain;
    if (gain != 1.0) options.gain = format("{}", gain);
    if (ExposureRequest::from(options).functions(timeline) != functions) return std::nullopt;
  } catch (const UsageError&) {  // no gain in the capture, or an interval that is too short for the shutter
    return std::nullopt;
  }
  OwnRecipe own{kAsItIs, {}};
  own.options["start"] = options.start;
  own.options["exposure"] = options.exposure;
  own.options["gain"] = options.gain;
  return own;
}

}  // namespace

std::optional<OwnRecipe> swept_recipe(const FunctionSet& functions, const Options& options,
                                      const Timeline& timeline, const std::string& functions_name) {
  if (!options.functions) {
    if (auto own = plain_recipe(functions, options, timeline)) return own;
  }
  std::string text;
  for (const auto& [tag, function] : functions) {
    const auto points = function.points();
    const bool jumps = std::ranges::adjacent_find(points, {}, &ControlPoint::time_ns) != points.end();
    if (jumps) return std::nullopt;
    text += function_text(tag, function) + "\n";
  }
  OwnRecipe own{kAsItIs, Recipe::Text{functions_name, std::move(text)}};
  for (const char* name : {"start", "exposure", "shutter", "shutter-error"}) own.options[name] = std::nullopt;
  return own;
}

}  // namespace nutik::app
