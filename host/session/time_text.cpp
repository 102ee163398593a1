#include "session/time_text.hpp"

#include <cmath>

#include "capture/format.hpp"

namespace nutik {

std::string duration_text(std::int64_t nanoseconds) {
  const auto value = static_cast<double>(nanoseconds);
  if (nanoseconds < 1000) return format("{} ns", nanoseconds);
  if (nanoseconds < 1'000'000) return format("{:.4g} us", value * 1e-3);
  if (nanoseconds < 1'000'000'000) return format("{:.4g} ms", value * 1e-6);
  return format("{:.4g} s", value * 1e-9);
}

std::string integral_text(double nanoseconds) {
  if (nanoseconds == 0.0) return "0 s";
  const double length = std::fabs(nanoseconds);
  // What would be rounded up to the next unit is shown in it.
  if (length >= 999'999'500.0) return format("{:.6g} s", nanoseconds * 1e-9);
  if (length >= 999'999.5) return format("{:.6g} ms", nanoseconds * 1e-6);
  if (length >= 999.9995) return format("{:.6g} us", nanoseconds * 1e-3);
  return format("{:.6g} ns", nanoseconds);
}

}  // namespace nutik
