#include "session/swept_recipe.hpp"

#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_text.hpp"

namespace nutik {
namespace {

// Of functions that are normalized and brightened already.
const std::map<std::string, std::optional<std::string>> kAsItIs{
    {"gain", std::nullopt}, {"ev", std::nullopt}, {"normalize", std::nullopt}};

// The interval from the function's first point to its last, as bright as the function.
std::optional<OwnRecipe> plain_recipe(const FunctionSet& functions, ExposureRequest request,
                                      const Timeline& timeline) {
  const auto points = functions.begin()->second.points();
  auto& plain = std::get<PlainInterval>(request.gains);
  request.start = StatedTime::of_nanoseconds(points.front().time_ns);
  plain.length = StatedTime::of_nanoseconds(points.back().time_ns - points.front().time_ns);
  request.normalization = {};
  request.gain = 1.0;
  try {
    const FunctionSet made = functions_of(request, timeline);
    const auto made_points = made.begin()->second.points();
    if (made_points.size() != points.size()) return std::nullopt;
    const auto strongest = std::ranges::max_element(
        made_points, {}, [](const ControlPoint& point) { return std::fabs(point.gain); });
    request.gain = points[static_cast<std::size_t>(strongest - made_points.begin())].gain / strongest->gain;
    if (functions_of(request, timeline) != functions) return std::nullopt;
  } catch (const UsageError&) {  // no gain in the capture, or an interval that is too short for the shutter
    return std::nullopt;
  }
  OwnRecipe own{kAsItIs, {}};
  own.options["start"] = request.start.text();
  own.options["exposure"] = plain.length.text();
  if (request.gain != 1.0) own.options["gain"] = format("{}", request.gain);
  return own;
}

}  // namespace

std::optional<OwnRecipe> swept_recipe(const FunctionSet& functions, const ExposureRequest& request,
                                      const Timeline& timeline, const std::string& functions_name) {
  if (request.is_plain()) {
    if (auto own = plain_recipe(functions, request, timeline)) return own;
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

}  // namespace nutik
