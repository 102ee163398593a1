// The curves by which cameras store light as nearly its logarithm, as their makers published them.
//
// A signal is a share of the largest code, 0 … 1; light is reflectance, 0.18 being a grey card, without an upper end.
#pragma once

#include <span>
#include <string_view>

#include "capture/primaries.hpp"

namespace nutik {

struct LogCurve {
  enum class Toe { straight, square_root, cube_root };

  std::string_view name;
  Primaries primaries;  // that its maker stores with it
  // Whether the formula counts signals on the whole scale of codes also in video of limited range, so that signal 0 is
  // code 0 of 10 bits and not 64.
  bool is_of_whole_codes;
  // Signal above the toe: scale · log10(gain · light + offset) + base.
  double gain, offset, scale, base;
  double toe_end;  // as a signal
  // straight: signal = toe_gain · light + toe_base. square_root, cube_root: light = (signal / toe_gain)^n + toe_base.
  double toe_gain, toe_base;
  Toe toe = Toe::straight;

  [[nodiscard]] double light_of(double signal) const;
  [[nodiscard]] double signal_of(double light) const;
};

[[nodiscard]] std::span<const LogCurve> log_curves();

}  // namespace nutik
