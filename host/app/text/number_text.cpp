#include "app/text/number_text.hpp"

#include <charconv>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {

std::uint32_t parse_whole_number(std::string_view text, std::string_view what, std::uint32_t low,
                                 std::uint32_t high) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high) {
    throw UsageError(format("{} '{}' is no whole number of {} … {}", what, text, low, high));
  }
  return value;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

double parse_number(std::string_view text, std::string_view what, double low, double high) {
  const auto value = parse_number(text);
  if (!value || *value < low || *value > high) {
    throw UsageError(format("{} '{}' is no number of {} … {}", what, text, low, high));
  }
  return *value;
}

std::vector<double> parse_numbers(std::string_view text, std::string_view what) {
  std::vector<double> numbers;
  for (;;) {
    const auto comma = text.find(',');
    const std::string_view part = text.substr(0, comma);
    const auto number = parse_number(part);
    if (!number)
      throw UsageError(
          format("{}: '{}' is no number; write numbers with commas between: 10,20,30", what, part));
    numbers.push_back(*number);
    if (comma == std::string_view::npos) return numbers;
    text = text.substr(comma + 1);
  }
}

}  // namespace nutik::app
