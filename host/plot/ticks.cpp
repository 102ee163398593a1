#include "plot/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "capture/format.hpp"

namespace nutik::plot {
namespace {

struct TimeUnit {
  const char* name;
  int decimals;  // of a nanosecond in it
};
constexpr std::array<TimeUnit, 4> kTimeUnits{{{"s", 9}, {"ms", 6}, {"µs", 3}, {"ns", 0}}};
constexpr int kMaxDecimals = 3;

// The least of 1, 2, 5 times a power of ten that is not below `least`.
struct RoundStep {
  double mantissa = 1.0;
  int exponent = 0;

  explicit RoundStep(double least) : exponent(static_cast<int>(std::floor(std::log10(least)))) {
    const double rest = least / std::pow(10.0, exponent);
    constexpr double kRounding = 1 + 1e-9;
    mantissa = rest <= kRounding ? 1.0 : rest <= 2 * kRounding ? 2.0 : rest <= 5 * kRounding ? 5.0 : 10.0;
    if (mantissa == 10.0) {
      mantissa = 1.0;
      ++exponent;
    }
  }
  [[nodiscard]] double value() const { return mantissa * std::pow(10.0, exponent); }
};

}  // namespace

Ticks time_ticks(std::int64_t begin_ns, std::int64_t end_ns, int most) {
  const auto span = static_cast<double>(end_ns - begin_ns);
  const RoundStep step(std::max(1.0, span / most));
  const auto step_ns = std::max<std::int64_t>(1, std::llround(step.value()));
  const std::int64_t largest_ns = std::max(std::abs(begin_ns), std::abs(end_ns));
  const auto fits = [&](const TimeUnit& unit) {
    return std::max(0, unit.decimals - step.exponent) <= kMaxDecimals &&
           static_cast<double>(largest_ns) >= std::pow(10.0, unit.decimals);
  };
  const auto found = std::find_if(kTimeUnits.begin(), kTimeUnits.end(), fits);
  const TimeUnit unit = found == kTimeUnits.end() ? kTimeUnits.back() : *found;
  const int decimals = std::max(0, unit.decimals - step.exponent);

  Ticks result{{}, unit.name};
  std::int64_t first = begin_ns / step_ns;
  if (first * step_ns < begin_ns) ++first;
  for (std::int64_t i = first; i * step_ns <= end_ns; ++i) {
    const auto at = static_cast<double>(i * step_ns);
    result.ticks.push_back({at, format("{:.{}f}", at / std::pow(10.0, unit.decimals), decimals)});
  }
  return result;
}

Ticks number_ticks(double low, double high, int most) {
  const RoundStep step((high - low) / most);
  const int decimals = std::max(0, -step.exponent);
  const double largest = std::max(std::fabs(low), std::fabs(high));
  const bool is_plain = largest < 1e6 && decimals <= 6;
  // Enough to tell neighbours apart.
  const int digits = 2 + static_cast<int>(std::max(0.0, std::log10(largest / step.value())));
  constexpr double kRounding = 1e-9;  // of a step: an end that is a round number gets its mark
  Ticks result;
  const double last = std::floor(high / step.value() + kRounding);
  for (double i = std::ceil(low / step.value() - kRounding); i <= last; ++i) {
    const double at = (i == 0 ? 0.0 : i) * step.value();  // never -0
    result.ticks.push_back({at, is_plain ? format("{:.{}f}", at, decimals) : format("{:.{}g}", at, digits)});
  }
  return result;
}

}  // namespace nutik::plot
