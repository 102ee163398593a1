#include "exposure/function_template.hpp"

#include "capture/format.hpp"

namespace nutik {

std::optional<std::vector<ControlPoint>> FunctionTemplate::points(const std::vector<TemplatePoint>& function,
                                                                  const std::vector<std::int64_t>& times_ns) {
  std::vector<ControlPoint> points;
  for (const TemplatePoint& point : function) {
    // Twice the largest time still fits.
    const std::int64_t time_ns = point.time_ns + (point.time_name ? times_ns[*point.time_name] : 0);
    if (time_ns > kLargestTimeNs || time_ns < -kLargestTimeNs) return std::nullopt;
    if (!points.empty() && time_ns <= points.back().time_ns) return std::nullopt;
    points.push_back({time_ns, point.gain});
  }
  return points;
}

std::string FunctionTemplate::text_with(const NamedNumbers& numbers) const {
  std::string written;
  std::size_t behind = 0;
  for (const Place& place : places) {
    written.append(text, behind, place.begin - behind);
    written += place.time ? format("{}", numbers.times_ns[*place.time] + place.added_ns)
                          : format("{}", numbers.gains[*place.gain]);
    behind = place.end;
  }
  return written.append(text, behind);
}

}  // namespace nutik
