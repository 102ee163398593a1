#include "render/precision_choice.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "capture/format.hpp"

namespace nutik {

PrecisionChoice choose_precision(const RenderPlan& plan, const OutputFormat& output,
                                 std::span<const Precision> available) {
  measure_tables(plan);
  std::vector<ErrorBound> rejected;
  for (const Precision precision : available) {
    ErrorBound bound = error_bound(plan, precision, output);
    if (bound.worst.steps <= kMaxSteps) return {std::move(bound), std::move(rejected)};
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
  if (output.type == ValueType::light64) return light;
  const bool is_power_of_two = std::has_single_bit(output.white_code + 1);
  const bool is_one = error.steps < 1.0;
  const char* plural = is_one ? "" : "s";
  const std::string step = output.type == ValueType::light32 ? format("float's step{}", plural)
                           : is_power_of_two
                               ? format("{}-bit code{}", std::bit_width(output.white_code), plural)
                               : format("code{} of {}", plural, output.white_code);
  const std::string_view article = step.starts_with('8') || step.starts_with("11-") ? "of an " : "of a ";
  return is_one ? format("{}, {:.2g} {}{}", light, error.steps, article, step)
                : format("{}, {:.3g} {}", light, error.steps, step);
}

}  // namespace nutik
