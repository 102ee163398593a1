// Normalizations: what the integral of light times gain is divided by (docs/explanation/model.md, "Normalization").
//
//   support      D, the time in the capture over which the gain is not zero
//   integral     ∫g: a still scene comes out as it is
//   absolute     ∫|g|
//   seconds:S    S seconds, whatever the function
//
// A plan and its renderers always divide by D. Another divisor X is a factor D / X on the gains, so that all
// that is promised of gain functions (the range of their tables, the bounds of their errors) holds as it stands.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "capture/rational.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

class Normalization {
 public:
  enum class Divisor { support, integral, absolute, seconds };

  // ∫g is taken for 0 where it is no more than this share of ∫|g|: rounding and the 1 ns steps of function
  // files leave such remainders of functions that were meant to cancel.
  static constexpr double kMinIntegralShare = 1e-6;

  Normalization() = default;  // support

  // `support`, `integral`, `absolute`, `seconds:0.5`. Throws UsageError for anything else.
  static Normalization parse(std::string_view text);
  [[nodiscard]] std::string text() const;
  // Whether other gains, none of them 0, have another divisor.
  [[nodiscard]] bool depends_on_gains() const {
    return divisor_ == Divisor::integral || divisor_ == Divisor::absolute;
  }

  // The function that, divided by D, gives `gain` · ∫ g v / X over a capture of this length: every gain times
  // one factor, `gain` · D / X, rounded once. A function that is zero in the capture comes back as it was.
  // Delays may bring any part of it into the capture: all of that is then of its whole course.
  // Throws InputError naming the function by `name` where X is an integral that cancels, or where a gain
  // leaves the range of numbers.
  [[nodiscard]] GainFunction normalized(const GainFunction& function, std::int64_t duration_ns, double gain,
                                        const std::string& name, bool has_delays = false) const;

  // D / X of such a function, whose D is not 0. Throws as above.
  [[nodiscard]] double factor_of(const GainSummary& summary, const std::string& name) const;

  friend bool operator==(const Normalization&, const Normalization&) = default;

 private:
  Divisor divisor_ = Divisor::support;
  Rational seconds_{1, 1};
};

}  // namespace nutik
