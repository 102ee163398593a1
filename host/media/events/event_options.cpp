#include "media/events/event_options.hpp"

#include <charconv>
#include <string>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

// A number that is all of the text.
std::optional<double> number_of(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

constexpr double kMinContrast = 0.001, kMaxContrast = 10;
constexpr double kMinStart = 0.0001;

}  // namespace

Contrast parse_contrast(std::string_view text) {
  const auto colon = text.find(':');
  const auto up = number_of(text.substr(0, colon));
  const auto down = colon == text.npos ? up : number_of(text.substr(colon + 1));
  const auto is_possible = [](std::optional<double> step) {
    return step && *step >= kMinContrast && *step <= kMaxContrast;
  };
  if (!is_possible(up) || !is_possible(down)) {
    throw UsageError(
        format("contrast '{}' is no step of log light; write 0.2, or one for up and one for down, 0.3:0.17, "
               "each from {} to {}",
               text, kMinContrast, kMaxContrast));
  }
  return {*up, *down};
}

StartLight parse_start_light(std::string_view text) {
  const auto light = number_of(text);
  if (!light) return std::filesystem::path(text);
  if (*light >= kMinStart && *light <= 1) return *light;
  throw UsageError(
      format("light {} at the start is outside {} … 1, of which 1 is white", text, kMinStart));
}

}  // namespace nutik
