#include "opencl/code_search.hpp"

#include <cmath>

namespace nutik {

std::vector<double> code_thresholds(const Transfer& transfer, std::uint32_t white_code, double white_light) {
  std::vector<double> thresholds = transfer.code_thresholds(white_code);
  for (std::size_t code = 1; code < thresholds.size(); ++code) {
    thresholds[code] = transfer.is_linear() ? (static_cast<double>(code) - 0.5) * white_light / white_code
                                            : thresholds[code] * white_light;
  }
  return thresholds;
}

std::optional<CodeSearch> code_search(std::vector<double> thresholds, double white_light, double roundoff) {
  constexpr std::uint32_t kMaxGuesses = 1u << 22;
  const double slack = 16 * roundoff;  // the device's √ times the number of steps errs by less
  const std::size_t white_code = thresholds.size() - 1;
  CodeSearch search{std::move(thresholds), {}};
  for (std::uint32_t steps = 1024; steps <= kMaxGuesses; steps *= 2) {
    search.guesses.assign(steps, 0);
    std::size_t code = 0;
    bool fits = true;
    for (std::uint32_t i = 0; i < steps && fits; ++i) {
      const auto root_before = [&](std::size_t c) {
        return std::sqrt(search.thresholds[c] / white_light) * steps;
      };
      const double begin = i - slack * steps;
      const double end = i + 1 + slack * steps;
      while (code < white_code && root_before(code + 1) <= begin) ++code;
      search.guesses[i] = static_cast<std::uint32_t>(code);
      fits = code + 2 > white_code || root_before(code + 2) > end;
    }
    if (fits) return search;
  }
  return std::nullopt;
}

}  // namespace nutik
