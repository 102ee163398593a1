#include "session/requests/own_exposure.hpp"

#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_text.hpp"

namespace nutik {
namespace {

// The interval from the function's first point to its last, as bright as the function.
std::optional<OwnInterval> own_interval(const FunctionSet& functions, ExposureRequest request,
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
  return OwnInterval{request.start, plain.length, request.gain};
}

}  // namespace

std::optional<OwnExposure> own_exposure(const FunctionSet& functions, const ExposureRequest& request,
                                        const Timeline& timeline, const std::string& functions_name) {
  if (request.is_plain()) {
    if (const auto interval = own_interval(functions, request, timeline)) return *interval;
  }
  std::string text;
  for (const auto& [tag, function] : functions) {
    const auto points = function.points();
    const bool jumps = std::ranges::adjacent_find(points, {}, &ControlPoint::time_ns) != points.end();
    if (jumps) return std::nullopt;
    text += function_text(tag, function) + "\n";
  }
  return Recipe::Text{functions_name, std::move(text)};
}

}  // namespace nutik
