#include "render/precision_choice.hpp"

#include <algorithm>
#include <utility>

#include "capture/format.hpp"

namespace nutik {

PrecisionChoice choose_precision(const RenderPlan& plan, const OutputFormat& output,
                                 std::span<const Precision> available) {
  std::vector<ErrorBound> rejected;
  for (const Precision precision : available) {
    ErrorBound bound = error_bound(plan, precision, output);
    if (bound.worst.steps <= kMostSteps) return {std::move(bound), std::move(rejected)};
    rejected.push_back(std::move(bound));
  }
  const auto best = std::min_element(rejected.begin(), rejected.end(), [](const auto& a, const auto& b) {
    return std::pair(a.worst.steps, a.worst.light) < std::pair(b.worst.steps, b.worst.light);
  });
  ErrorBound bound = std::move(*best);
  rejected.erase(best);
  return {std::move(bound), std::move(rejected)};
}

std::string error_text(const PictureError& error, const OutputFormat& output) {
  const std::string light = format("light within {:.2g}", error.light);
  switch (output.type) {
    case ValueType::code8: return format("{}, {:.2g} of an 8-bit code", light, error.steps);
    case ValueType::code16:
      return format("{}, {:.2g} of a code of white {}", light, error.steps, output.white_code);
    case ValueType::light32: return format("{}, {:.2g} of a float's step at full light", light, error.steps);
    case ValueType::light64: return light;
  }
  return light;
}

}  // namespace nutik
