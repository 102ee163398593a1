// Times in which a digit was probably lost, or typed once too often.
//
// A step is written as two control points at most 1 µs apart. Lose a digit of the first, and the step becomes
// a ramp that starts far too early, without any rule of the format being broken: the printed Figure 14 has
// [100000000:1], [1000000002:-25]. So a ramp is suspicious if one digit more or one less, anywhere in one of
// its two times, makes it a step again with all times still in order. Every digit whose loss
// turns a step into a ramp is found this way, except a first one before zeros, whose loss leaves zeros to be
// seen at the front. Ramps between times of whole milliseconds are never suspicious: 0.6 s to 0.8 s, or 0.1 s
// to 1 s, where one more zero would put both points at one time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exposure/gain_function.hpp"

namespace nutik {

inline constexpr std::int64_t kLongestStepNs = 1000;

struct MistypedTime {
  std::size_t point = 0;  // whose time it is
  std::size_t ramp = 0;   // the ramp is between the control points `ramp` and `ramp` + 1
  std::int64_t likely_ns = 0;
  std::int64_t step_ns = 0;   // how long the ramp is then
  bool is_digit_lost = true;  // else it has one too many
};

// At most one for each ramp: of all times that one digit makes, a lost digit goes before one too many, then
// one that stands in a run of its own kind (as zeros do), then the shortest step.
[[nodiscard]] std::vector<MistypedTime> mistyped_times(const GainFunction& function);

}  // namespace nutik
