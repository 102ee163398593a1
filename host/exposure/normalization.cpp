#include "exposure/normalization.hpp"

#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

Normalization Normalization::parse(std::string_view text) {
  constexpr std::string_view kSeconds = "seconds:";
  Normalization normalization;
  if (text == "support") return normalization;
  if (text == "integral") {
    normalization.divisor_ = Divisor::integral;
  } else if (text == "absolute") {
    normalization.divisor_ = Divisor::absolute;
  } else if (text.starts_with(kSeconds)) {
    normalization.divisor_ = Divisor::seconds;
    normalization.seconds_ = Rational::parse(text.substr(kSeconds.size()), "normalization");
    if (normalization.seconds_.numerator <= 0) {
      throw UsageError(format("normalization '{}': the seconds must be more than 0", text));
    }
  } else {
    throw UsageError(format(
        "normalization '{}' is not known; choose support, integral, absolute or seconds:S, as in seconds:0.5",
        text));
  }
  return normalization;
}

std::string Normalization::text() const {
  switch (divisor_) {
    case Divisor::support: return "support";
    case Divisor::integral: return "integral";
    case Divisor::absolute: return "absolute";
    case Divisor::seconds: break;
  }
  return format("seconds:{}", seconds_.text());
}

double Normalization::factor_of(const GainSummary& summary, const std::string& name) const {
  const auto support_ns = static_cast<double>(summary.support_ns);
  switch (divisor_) {
    case Divisor::support: return 1.0;
    case Divisor::integral:
      if (std::fabs(summary.integral_ns) <= kMinIntegralShare * summary.absolute_integral_ns) {
        throw InputError(
            format("{}: the positive and negative parts of its gains cancel (the still gain is {:.3g}), so "
                   "there is no integral to divide by; use support, absolute or seconds:S",
                   name, summary.still_gain()),
            {Setting::normalization});
      }
      return std::scalbn(support_ns / summary.integral_ns, -summary.exponent);
    case Divisor::absolute: return std::scalbn(support_ns / summary.absolute_integral_ns, -summary.exponent);
    case Divisor::seconds: break;
  }
  return static_cast<double>(static_cast<int128>(summary.support_ns) * seconds_.denominator) /
         static_cast<double>(static_cast<int128>(seconds_.numerator) * kSecondNs);
}

GainFunction Normalization::normalized(const GainFunction& function, std::int64_t duration_ns, double gain,
                                       const std::string& name, bool has_delays) const {
  if (divisor_ == Divisor::support && gain == 1.0) return function;
  const GainSummary summary =
      has_delays ? summarize_course(function, duration_ns) : summarize(function, duration_ns);
  if (summary.support_ns == 0) return function;
  const double factor = gain * factor_of(summary, name);
  try {
    return function.scaled(factor);
  } catch (const InputError& error) {
    throw InputError(format("{}: {}", name, error.what()), error.settings());
  }
}

}  // namespace nutik
