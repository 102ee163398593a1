// How kernels find the code of a light value: a guess from the light's square root, and one comparison.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/transfer.hpp"

namespace nutik {

template <typename Real>
struct CodeSearch {
  // Least light of each code, and an infinite one behind the white code's.
  std::vector<Real> thresholds;
  // For each of as many equal steps of √light the code at its start, or the one below: no step holds more
  // than one threshold, roundings of the device's square root included.
  std::vector<std::uint32_t> guesses;
};

// Throws UsageError where codes lie too close for that: beyond 2^22 steps (a gamma above 3 or so, whose
// first codes hardly differ in light).
template <typename Real>
[[nodiscard]] CodeSearch<Real> code_search(const Transfer& transfer, std::uint32_t white_code) {
  constexpr std::uint32_t kMostSteps = 1u << 22;
  // The device's √light times the number of steps errs by a few units in the last place.
  constexpr double kSlack = 8 * std::numeric_limits<Real>::epsilon();
  CodeSearch<Real> search;
  for (const double threshold : transfer.code_thresholds(white_code)) {
    search.thresholds.push_back(static_cast<Real>(threshold));
  }
  for (std::uint32_t steps = 1024; steps <= kMostSteps; steps *= 2) {
    search.guesses.assign(steps, 0);
    std::size_t code = 0;
    bool fits = true;
    for (std::uint32_t i = 0; i < steps && fits; ++i) {
      const auto root_before = [&](std::size_t c) {
        return std::sqrt(static_cast<double>(search.thresholds[c])) * steps;
      };
      const double begin = i - kSlack * steps;
      const double end = i + 1 + kSlack * steps;
      while (code < white_code && root_before(code + 1) <= begin) ++code;
      search.guesses[i] = static_cast<std::uint32_t>(code);
      fits = code + 2 > white_code || root_before(code + 2) > end;
    }
    if (!fits) continue;
    search.thresholds.push_back(std::numeric_limits<Real>::infinity());
    return search;
  }
  throw UsageError(
      format("transfer {} puts codes of a white of {} too close together to tell apart; write "
             "floating point (--depth float), or use --renderer reference",
             transfer.text(), white_code));
}

}  // namespace nutik
