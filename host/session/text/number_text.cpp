#include "session/text/number_text.hpp"

#include <cctype>
#include <charconv>
#include <cmath>

#include "session/text/text_table.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

std::uint32_t parse_whole_number(std::string_view text, std::string_view what, std::uint32_t low,
                                 std::uint32_t high) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high) {
    throw UsageError(format("{} '{}' is no whole number of {} … {}", what, text, low, high));
  }
  return value;
}

std::pair<std::uint32_t, std::uint32_t> parse_pair(std::string_view text, char between,
                                                   const WholeNumber& first, const WholeNumber& second,
                                                   const std::string& otherwise) {
  const auto at = text.find(between);
  if (at == std::string_view::npos) throw UsageError(otherwise);
  return {parse_whole_number(text.substr(0, at), first.what, first.low, first.high),
          parse_whole_number(text.substr(at + 1), second.what, second.low, second.high)};
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

double parse_number(std::string_view text, std::string_view what, double low, double high) {
  const auto value = parse_number(text);
  if (!value || *value < low || *value > high)
    throw UsageError(format("{} '{}' is no number of {} … {}", what, text, low, high));
  return *value;
}

std::optional<std::uint64_t> parse_bytes(std::string_view text) {
  std::uint64_t bytes = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bytes);
  if (error != std::errc()) return std::nullopt;
  std::string unit;  // in small letters, without the B of bytes
  for (const char c : text.substr(static_cast<std::size_t>(end - text.data()))) {
    if (c != ' ' || !unit.empty()) unit += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (unit.ends_with('b')) unit.pop_back();
  const std::uint64_t factor = unit.ends_with('i') ? 1024 : 1000;
  if (factor == 1024) unit.pop_back();
  if (unit.empty()) return factor == 1000 ? std::optional(bytes) : std::nullopt;
  const auto power = std::string_view("kmgtpe").find(unit);
  if (unit.size() > 1 || power == std::string_view::npos) return std::nullopt;
  for (std::size_t k = 0; k <= power; ++k) {
    if (__builtin_mul_overflow(bytes, factor, &bytes)) return std::nullopt;
  }
  return bytes;
}

std::vector<double> parse_numbers(std::string_view text, std::string_view what) {
  std::vector<double> numbers;
  // Behind the last comma stands a number, too.
  for (const std::string& part : parts_of(std::string(text) + ",", ',')) {
    const auto number = parse_number(part);
    if (!number)
      throw UsageError(
          format("{}: '{}' is no number; write numbers with commas between: 10,20,30", what, part));
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace nutik
