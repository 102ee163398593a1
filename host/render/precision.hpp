// The arithmetics that a picture can be computed in. docs/explanation/accuracy.md says what each may err by.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace nutik {

enum class Precision {
  single_,      // float
  compensated,  // pairs of floats, whose sum is the number: for devices without double
  double_,      // double
  fixed         // whole numbers of 64 bits: the same sums in every order of work and on every device
};

inline constexpr std::array kPrecisions{Precision::single_, Precision::compensated, Precision::double_,
                                        Precision::fixed};

[[nodiscard]] std::string to_text(Precision precision);  // `single`, `compensated`, `double`, `fixed`

// Throws UsageError listing the names where none is meant.
[[nodiscard]] Precision parse_precision(std::string_view text);

}  // namespace nutik
