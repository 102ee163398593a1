// Exact rational arithmetic: what weights, tables and light really are, to measure errors against.
//
// Written from docs/explanation/model.md with another formula than either renderer: Simpson's rule, which is exact
// for the product of two straight lines.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <vector>

#include "capture/timeline.hpp"
#include "exposure/gain_function.hpp"

namespace nutik::test {

using Exact = boost::multiprecision::cpp_rational;

// How far a double is from the exact value, in `scale`; infinite for what is not a number.
[[nodiscard]] double error_in(const Exact& scale, double value, const Exact& exact);

// The nearest whole number, of two that are as near the upper one.
[[nodiscard]] std::int64_t rounded_half_up(const Exact& value);

// A straight stretch of a function of time.
struct ExactStretch {
  std::int64_t begin_ns;
  std::int64_t end_ns;
  Exact begin;
  Exact end;

  [[nodiscard]] Exact at(std::int64_t time_ns) const {
    return begin + (end - begin) * Exact(time_ns - begin_ns) / Exact(end_ns - begin_ns);
  }
  [[nodiscard]] bool is_zero() const { return begin == 0 && end == 0; }
};

// The gain function on the domain [0, duration_ns], so much later.
[[nodiscard]] std::vector<ExactStretch> exact_gain(const GainFunction& function, std::int64_t duration_ns,
                                                   std::int64_t delay_ns = 0);

// D of a function that may be delayed: how long it is not 0 from its first control point to its last and from 0 to
// duration_ns.
[[nodiscard]] std::int64_t exact_course_support_ns(const GainFunction& function, std::int64_t duration_ns);

// The first of stretches in time order that ends after a time.
[[nodiscard]] std::vector<ExactStretch>::const_iterator first_stretch_after(
    const std::vector<ExactStretch>& stretches, std::int64_t time_ns);

// ∫ of the product of two functions that are straight on each of their stretches.
[[nodiscard]] Exact integrate_product(const std::vector<ExactStretch>& a, const std::vector<ExactStretch>& b);

struct ExactSummary {
  Exact integral_ns;            // ∫g
  Exact absolute_integral_ns;   // ∫|g|
  std::int64_t support_ns = 0;  // D
  // S; 0 where D is 0.
  [[nodiscard]] Exact scale() const {
    return support_ns == 0 ? Exact(0) : Exact(absolute_integral_ns / support_ns);
  }
};
[[nodiscard]] ExactSummary exact_summary(const std::vector<ExactStretch>& gain);

// The line between |g| at the ends of each stretch: ĝ, what errors of weights are in proportion to.
[[nodiscard]] std::vector<ExactStretch> magnitude_of(std::vector<ExactStretch> gain);

// Sample k's own hat on the timeline.
[[nodiscard]] std::vector<ExactStretch> exact_hat(const Timeline& timeline, std::uint64_t k);

// ∫ g φ_k, in nanoseconds.
[[nodiscard]] Exact exact_weight_ns(const std::vector<ExactStretch>& gain, const Timeline& timeline,
                                    std::uint64_t k);

}  // namespace nutik::test
