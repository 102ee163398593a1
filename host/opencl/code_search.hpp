// How kernels find the code of a light value: a guess from the light's square root, and one comparison.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

struct CodeSearch {
  // Least light of each code of the picture, as the kernel compares with it; the first is 0.
  std::vector<double> thresholds;
  // For each of as many equal steps of √(light / white) the code at its start, or the one below: no step holds
  // more than one threshold, roundings of the device's square root included.
  std::vector<std::uint32_t> guesses;
};

// Least light of each code, where light 1 is `white_light`, correctly rounded where light is linear.
[[nodiscard]] std::vector<double> code_thresholds(const Transfer& transfer, std::uint32_t white_code,
                                                  double white_light);

// `thresholds` increase from 0 to at most white_light; guesses are made in arithmetic of unit roundoff
// `roundoff`. None where codes lie too close to be told apart by one comparison: beyond 2^22 steps (a gamma above 3 or
// so, or PQ, whose first codes hardly differ in light).
[[nodiscard]] std::optional<CodeSearch> code_search(std::vector<double> thresholds, double white_light,
                                                    double roundoff);

}  // namespace nutik
