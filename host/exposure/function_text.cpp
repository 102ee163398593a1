#include "exposure/function_text.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/rational.hpp"

namespace nutik {

GainFunction with_steps(const GainFunction& function) {
  const auto given = function.points();
  std::vector<ControlPoint> points(given.begin(), given.end());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].time_ns != points[i + 1].time_ns) continue;
    const bool grows = std::fabs(points[i].gain) < std::fabs(points[i + 1].gain);
    if (grows) {
      --points[i].time_ns;
    } else {
      ++points[i + 1].time_ns;
    }
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].time_ns < points[i + 1].time_ns) continue;
    throw UsageError(
        format("the gain jumps twice round {} ns: in a function file a jump takes 1 ns, and there is no room "
               "for that",
               points[i].time_ns));
  }
  if (points.front().time_ns < -kLargestTimeNs || points.back().time_ns > kLargestTimeNs) {
    throw UsageError(
        format("the gain jumps at a last possible time, {} ns: in a function file a jump takes 1 ns more",
               kLargestTimeNs));
  }
  return GainFunction(std::move(points));
}

std::string function_text(std::uint8_t tag, const GainFunction& function) {
  const GainFunction stepped = with_steps(function);
  std::string text = format("M{}", tag);
  const char* separator = " ";
  for (const ControlPoint& point : stepped.points()) {
    text += format("{}[{}:{}]", std::exchange(separator, ", "), point.time_ns, point.gain);
  }
  return text;
}

}  // namespace nutik
