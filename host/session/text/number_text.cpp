#include "session/text/number_text.hpp"

#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"

namespace nutik {

std::uint32_t parse_whole_number(std::string_view text, std::string_view what, std::uint32_t low,
                                 std::uint32_t high) {
  const auto value = parsed<std::uint32_t>(text);
  if (!value || *value < low || *value > high)
    throw UsageError(format("{} '{}' is no whole number of {} … {}", what, text, low, high));
  return *value;
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
  const auto value = parsed<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

double parse_number(std::string_view text, std::string_view what, double low, double high) {
  const auto value = parse_number(text);
  if (!value || *value < low || *value > high)
    throw UsageError(format("{} '{}' is no number of {} … {}", what, text, low, high));
  return *value;
}

std::optional<std::uint64_t> parse_bytes(std::string_view text) {
  double bytes = 0;
  if (!take_number(text, bytes)) return std::nullopt;
  // Without blanks before it and the B of bytes.
  std::string unit = in_small_letters(text.substr(std::min(text.find_first_not_of(' '), text.size())));
  if (unit.ends_with('b')) unit.pop_back();
  const double factor = unit.ends_with('i') ? 1024 : 1000;
  if (factor == 1024) unit.pop_back();
  const auto power = std::string_view("kmgtpe").find(unit);
  if (unit.size() > 1 || power == std::string_view::npos || (unit.empty() && factor == 1024)) return std::nullopt;
  for (std::size_t k = 0; k <= power && !unit.empty(); ++k) bytes *= factor;
  if (!(bytes >= 0 && bytes < 0x1p64)) return std::nullopt;
  return static_cast<std::uint64_t>(bytes);
}

std::vector<double> parse_numbers(std::string_view text, std::string_view option) {
  std::vector<double> numbers;
  // Behind the last comma stands a number, too.
  for (const std::string& part : parts_of(std::string(text) + ",", ',')) {
    const auto number = parse_number(part);
    if (!number)
      throw UsageError(
          Advice{format("`{}`: '{}' is no number; write numbers with commas between: 10,20,30", option, part)});
    numbers.push_back(*number);
  }
  return numbers;
}

std::string counted(std::uint64_t count, std::string_view name) {
  return format("{} {}{}", count, name, count == 1 ? "" : "s");
}

std::string percent_text(std::uint64_t part, std::uint64_t whole) {
  return format("{:.3g} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string saturated_text(const Saturation& saturation) {
  const auto [below, above] = saturation;
  if (below == 0 && above == 0) return "no pixel below 0 or above 1";
  if (above == 0) return format("{} saturated below 0", counted(below, "pixel"));
  if (below == 0) return format("{} saturated above 1", counted(above, "pixel"));
  return format("{} saturated below 0 and {} above 1", counted(below, "pixel"), above);
}

std::string bytes_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (bytes < 1000) return format("{} bytes", bytes);
  if (value < 999.5e3) return format("{:.3g} kB", value * 1e-3);
  if (value < 999.5e6) return format("{:.3g} MB", value * 1e-6);
  return format("{:.3g} GB", value * 1e-9);
}

std::string shape_text(const Shape& shape) {
  return format("{} x {} {}", shape.width, shape.height, shape.channels == 1 ? "grey" : "colour");
}

std::string aspect_text(const Rational& aspect) {
  return format("{}:{}", aspect.numerator, aspect.denominator);
}

std::string duration_text(std::int64_t nanoseconds) {
  if (nanoseconds < 0) return "-" + duration_text(-nanoseconds);
  const auto value = static_cast<double>(nanoseconds);
  if (nanoseconds < 1000) return format("{} ns", nanoseconds);
  if (nanoseconds < 1'000'000) return format("{:.4g} us", value * 1e-3);
  if (nanoseconds < 1'000'000'000) return format("{:.4g} ms", value * 1e-6);
  constexpr double kHour = 3600, kDay = 24 * kHour, kYear = 365.25 * kDay;
  constexpr double kFourDigits = 9999.5;
  const double seconds = value * 1e-9;
  if (seconds < kFourDigits) return format("{:.4g} s", seconds);
  if (seconds < kFourDigits * kHour) return format("{:.4g} h", seconds / kHour);
  if (seconds < kFourDigits * kDay) return format("{:.4g} days", seconds / kDay);
  return format("{:.4g} years", seconds / kYear);
}

std::string rate_text(const Rational& rate, std::string_view name) {
  if (rate.numerator >= rate.denominator) return format("{} {}s a second", rate.text(), name);
  const std::int64_t period_ns =
      round_half_up(static_cast<int128>(rate.denominator) * kSecondNs, rate.numerator);
  return format("a {} every {}", name, duration_text(period_ns));
}

std::string rate_text(const Timeline& timeline) {
  const Rational rate = timeline.rate();
  if (timeline.is_constant()) return rate_text(rate, "picture");
  if (rate.value() < 1) return rate_text(rate, "picture") + " on average, at irregular times";
  return format("irregular times, {:.4g} pictures a second on average", rate.value());
}

std::string integral_text(double nanoseconds) {
  if (nanoseconds == 0.0) return "0 s";
  const double length = std::fabs(nanoseconds);
  constexpr double kDay = 86'400e9;
  // What would be rounded up to the next unit is shown in it.
  if (length >= 999'999.5e9) return format("{:.6g} days", nanoseconds / kDay);
  if (length >= 999'999'500.0) return format("{:.6g} s", nanoseconds * 1e-9);
  if (length >= 999'999.5) return format("{:.6g} ms", nanoseconds * 1e-6);
  if (length >= 999.9995) return format("{:.6g} us", nanoseconds * 1e-3);
  return format("{:.6g} ns", nanoseconds);
}

}  // namespace nutik
