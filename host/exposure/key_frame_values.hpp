// Values and gain functions between two key frames.
//
//   in:      what holds at both keys, and how far a moment lies between them
//   out:     what holds at that moment
//   always:  at a key it is the key's, to the last bit; times are rounded half up to whole nanoseconds, once
#pragma once

#include <cstdint>

#include "exposure/gain_function.hpp"

namespace nutik {

// passed / whole of the way from one key to the next: 0 <= passed <= whole, 0 < whole <= 2 · kLargestTimeNs.
struct KeyShare {
  std::int64_t passed = 0;
  std::int64_t whole = 1;

  [[nodiscard]] double value() const { return static_cast<double>(passed) / static_cast<double>(whole); }
  friend bool operator==(const KeyShare&, const KeyShare&) = default;
};

// On the straight line from `a` to `b`, both within kLargestTimeNs.
[[nodiscard]] std::int64_t time_between(std::int64_t a_ns, std::int64_t b_ns, const KeyShare& share);

// Where both have as many control points, each is on its way from the one to the other, in time and gain. Else it is
// the mixture of both functions, (1 − λ) a + λ b, which has the control points of both. A jump is taken for a step of 1
// ns (with_steps()).
[[nodiscard]] GainFunction function_between(const GainFunction& a, const GainFunction& b,
                                            const KeyShare& share);

}  // namespace nutik
