#include "session/text/time_text.hpp"

#include <cmath>

#include "capture/format.hpp"

namespace nutik {

std::string duration_text(std::int64_t nanoseconds) {
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
