#include "session/requests/exposure_request.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/gain_function.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

constexpr const char* kPlainName = "the exposure";

const FunctionSet& functions_in(const ExposureRequest& request) {
  const FunctionSet& functions = *std::get<Shared<FunctionSet>>(request.gains);
  if (functions.empty()) throw UsageError("an exposure needs a gain function");
  if (!request.mask && functions.size() > 1) {
    throw UsageError(format("there are {} gain functions; a mask says where each applies", functions.size()));
  }
  return functions;
}

// Functions that no pixel uses are not checked.
bool is_used(const ExposureRequest& request, std::uint8_t tag) {
  return !request.mask || (*request.mask)->uses(tag);
}

GainFunction function_of(const PlainInterval& plain, const Exposure& interval,
                         const std::optional<DelayRequest>& delay, const Timeline& timeline) {
  const auto [earlier, later] = delay_ends_ns(delay);
  if (interval.start_ns >= int128{timeline.duration_ns()} - earlier || interval.end_ns <= -later) {
    throw UsageError(format("the interval from {} on {}lies outside the capture, which lasts {}",
                            duration_text(interval.start_ns), delay ? "with all its delays " : "",
                            duration_text(timeline.duration_ns())));
  }
  return plain.shutter.function({interval.start_ns, interval.end_ns});
}

}  // namespace

FunctionSet functions_of(const ExposureRequest& request, const Timeline& timeline) {
  if (const auto* plain = std::get_if<PlainInterval>(&request.gains)) {
    return functions_of(request, plain_interval(request.start, plain->length, timeline), timeline);
  }
  const std::int64_t zero_ns = moment_ns(request.start, timeline);
  return functions_of(request, Exposure{zero_ns, zero_ns}, timeline);
}

FunctionSet functions_of(const ExposureRequest& request, const Exposure& interval, const Timeline& timeline) {
  FunctionSet functions;
  const auto add = [&](std::uint8_t tag, const GainFunction& function, const std::string& name) {
    functions.emplace(tag, request.normalization.normalized(function, timeline.duration_ns(), request.gain, name,
                                                            request.delay.has_value()));
  };
  if (const auto* plain = std::get_if<PlainInterval>(&request.gains)) {
    add(0, function_of(*plain, interval, request.delay, timeline), kPlainName);
    return functions;
  }
  for (const auto& [tag, written] : functions_in(request)) {
    if (!is_used(request, tag)) continue;
    add(tag, interval.start_ns == 0 ? written : written.shifted(interval.start_ns), format("M{}", tag));
  }
  return functions;
}

std::int64_t functions_end_ns(const ExposureRequest& request) {
  std::int64_t end_ns = 0;
  for (const auto& [tag, function] : functions_in(request)) {
    if (!is_used(request, tag)) continue;
    const auto points = function.points();
    const auto is_live = [](const ControlPoint& point) { return point.gain != 0.0; };
    const auto dark =
        std::find_if(points.rbegin(), points.rend(), is_live).base();  // behind the last live one
    if (dark == points.begin()) continue;
    end_ns = std::max(end_ns, dark == points.end() ? points.back().time_ns : dark->time_ns);
  }
  return end_ns;
}

Combining Combining::parse(std::string_view text) {
  if (text == "mean") return {Combine::integral, true};
  const std::string_view names[]{"integral", "lighten", "darken", "median"};
  const auto found = std::ranges::find(names, text);
  if (found == std::end(names))
    throw UsageError(format("light is not combined as '{}'; choose integral, mean, lighten, darken or median", text));
  return {static_cast<Combine>(found - std::begin(names))};
}

Mask mask_of(const ExposureRequest& request, const Shape& shape) {
  if (request.mask) return (*request.mask)->mask;
  return Mask::uniform(shape.width, shape.height,
                       request.is_plain() ? std::uint8_t{0} : functions_in(request).begin()->first);
}

PlanOptions plan_options_of(const ExposureRequest& request, const Shape& shape) {
  PlanOptions options = request.plan;
  if (request.is_plain()) options.function_name = kPlainName;
  if (request.delay) options.delays = delays_of(*request.delay, shape);
  return options;
}

}  // namespace nutik
