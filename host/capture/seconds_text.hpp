// A time in seconds for people: `0.4 s`, `1036800 s`, never with an exponent where it is long.
#pragma once

#include <cstdint>
#include <string>

#include "capture/format.hpp"

namespace nutik {

[[nodiscard]] inline std::string seconds_text(std::int64_t nanoseconds) {
  const double seconds = static_cast<double>(nanoseconds) * 1e-9;
  return seconds < 999'999.5 ? format("{:.6g} s", seconds) : format("{:.0f} s", seconds);
}

}  // namespace nutik
