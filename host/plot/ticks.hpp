// Where an axis is marked, and with what: round numbers in a unit that fits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nutik::plot {

struct Tick {
  double at = 0.0;  // in the axis's own unit, nanoseconds for times
  std::string label;
};

struct Ticks {
  std::vector<Tick> ticks;  // increasing, within the axis
  std::string unit;         // of the labels: `s`, `ms`, `µs`, `ns`; empty for numbers
};

// Marks at 1, 2 or 5 times a power of ten, about `most` of them and never more than that and one. Times
// are whole nanoseconds, shown with at most three decimals where a unit allows that. begin < end.
[[nodiscard]] Ticks time_ticks(std::int64_t begin_ns, std::int64_t end_ns, int most);
[[nodiscard]] Ticks number_ticks(double low, double high, int most);

}  // namespace nutik::plot
