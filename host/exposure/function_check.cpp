#include "exposure/function_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

#include "capture/format.hpp"
#include "capture/seconds_text.hpp"
#include "capture/text.hpp"

namespace nutik {
namespace {

std::size_t digit_count(std::int64_t magnitude) {
  std::size_t count = 1;
  for (; magnitude >= 10; magnitude /= 10) ++count;
  return count;
}

// A time that one digit makes out of another.
struct Candidate {
  std::int64_t time_ns;
  bool is_digit_lost;  // the digit was added again
  bool is_in_run;      // beside another one like it
};

// Calls visit(candidate) for every time that differs from `time_ns` by one digit more or less.
template <typename Visit>
void for_each_candidate(std::int64_t time_ns, Visit visit) {
  const std::string digits = std::to_string(std::abs(time_ns));
  const auto offer = [&](const std::string& text, bool is_digit_lost, bool is_in_run) {
    const auto magnitude = parsed<std::int64_t>(text);
    if (!magnitude || *magnitude > kLargestTimeNs) return;
    visit(Candidate{time_ns < 0 ? -*magnitude : *magnitude, is_digit_lost, is_in_run});
  };
  for (std::size_t at = 0; at <= digits.size(); ++at) {
    for (char digit = '0'; digit <= '9'; ++digit) {
      const bool is_in_run =
          (at > 0 && digits[at - 1] == digit) || (at < digits.size() && digits[at] == digit);
      offer(std::string(digits).insert(at, 1, digit), true, is_in_run);
    }
  }
  for (std::size_t at = 0; at < digits.size() && digits.size() > 1; ++at) {
    const bool is_in_run =
        (at > 0 && digits[at - 1] == digits[at]) || (at + 1 < digits.size() && digits[at + 1] == digits[at]);
    offer(std::string(digits).erase(at, 1), false, is_in_run);
  }
}

// Whether a number with a digit more or less than `time_ns` can lie in the window: nearly no ramp gets further.
bool may_reach(std::int64_t time_ns, std::int64_t low_ns, std::int64_t high_ns) {
  const std::size_t count = digit_count(std::abs(time_ns));
  const std::size_t low = digit_count(std::abs(low_ns));
  const std::size_t high = digit_count(std::abs(high_ns));
  const auto [least, most] = std::minmax(low, high);
  // A window round 0 has small numbers of every length.
  return (low_ns <= 0 && high_ns >= 0) || (count + 1 >= least && count <= most + 1);
}

using Kind = FunctionFinding::Kind;

// A still gain this near to 0, in units of ∫|g| / D, or this far above 1, is one of rounding: the least
// difference that a 16-bit picture shows is 15 times as much.
constexpr double kRounding = 1e-6;

// The first control point next to a part that is not zero and lies outside.
template <typename IsOutside>
std::optional<std::size_t> first_outside(const GainFunction& function, IsOutside is_outside) {
  const auto points = function.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_live = points[i].gain != 0.0 || (i > 0 && points[i - 1].gain != 0.0) ||
                         (i + 1 < points.size() && points[i + 1].gain != 0.0);
    if (is_live && is_outside(points[i].time_ns)) return i;
  }
  return std::nullopt;
}

// One finding for both ends: a function that means to expose a moment is not zero on either side of it.
std::optional<FunctionFinding> held_finding(const GainFunction& function, const GainSummary& summary,
                                            const CheckedDomain& domain) {
  const bool is_held_after = domain.is_capture ? summary.exposes_to_the_end : function.last_gain() != 0.0;
  std::string held;
  if (summary.exposes_from_the_start) {
    held = format("the first gain, {}, holds from the start of the capture", function.first_gain());
  }
  if (is_held_after) {
    held += format("{}the last gain, {}, holds to the end of the capture", held.empty() ? "" : ", and ",
                   function.last_gain());
    if (domain.is_capture) held += " at " + seconds_text(domain.duration_ns);
  }
  if (held.empty()) return std::nullopt;
  const std::size_t point = is_held_after ? function.points().size() - 1 : 0;
  return FunctionFinding{Kind::held_gain, held + "; put a gain of 0 beside it if it should not", point};
}

std::optional<FunctionFinding> still_gain_finding(const GainSummary& summary) {
  if (summary.support_ns == 0) return std::nullopt;
  const double still_gain = summary.still_gain();
  if (std::fabs(still_gain) <= kRounding * summary.error_scale()) {
    return FunctionFinding{
        Kind::still_gain_not_positive,
        "the still gain is 0: its positive and negative parts cancel, so that whatever does "
        "not move comes out black",
        std::nullopt};
  }
  if (still_gain < 0.0) {
    return FunctionFinding{
        Kind::still_gain_not_positive,
        format("the still gain is {:.6g}: whatever does not move comes out black; formats with floating "
               "point keep light below 0",
               still_gain),
        std::nullopt};
  }
  if (still_gain > 1.0 + kRounding) {
    return FunctionFinding{
        Kind::still_gain_saturates,
        format("the still gain is {:.6g}: whatever does not move and has more than {:.3g} % of white's "
               "light comes out white; gains divided by {:.6g} keep it, or a format with floating point",
               still_gain, 100.0 / still_gain, still_gain),
        std::nullopt};
  }
  return std::nullopt;
}

FunctionFinding mistyped_finding(const GainFunction& function, const MistypedTime& mistyped) {
  const ControlPoint& begin = function.points()[mistyped.ramp];
  const ControlPoint& end = function.points()[mistyped.ramp + 1];
  return {
      Kind::mistyped_time,
      format("time {} probably {}: it is likely {}, which makes the ramp from gain {} to {} a step of {} ns; "
             "now it takes {:.6g} ms",
             function.points()[mistyped.point].time_ns,
             mistyped.is_digit_lost ? "has lost a digit" : "has a digit too many", mistyped.likely_ns,
             begin.gain, end.gain, mistyped.step_ns, static_cast<double>(end.time_ns - begin.time_ns) * 1e-6),
      mistyped.point};
}

}  // namespace

std::vector<MistypedTime> mistyped_times(const GainFunction& function) {
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  const auto points = function.points();
  std::vector<MistypedTime> found;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const std::int64_t begin_ns = points[i].time_ns;
    const std::int64_t end_ns = points[i + 1].time_ns;
    if (points[i].gain == points[i + 1].gain || end_ns - begin_ns <= kLongestStepNs) continue;
    std::optional<MistypedTime> best;
    const auto rank = [](const MistypedTime& time, bool is_in_run) {
      return std::tuple(!time.is_digit_lost, !is_in_run, time.step_ns);
    };
    bool best_is_in_run = false;
    // `other_ns` is the ramp's other end; the new time must lie in [low_ns, high_ns].
    const auto try_end = [&](std::size_t point, std::int64_t other_ns, std::int64_t low_ns,
                             std::int64_t high_ns) {
      if (low_ns > high_ns || !may_reach(points[point].time_ns, low_ns, high_ns)) return;
      for_each_candidate(points[point].time_ns, [&](const Candidate& candidate) {
        if (candidate.time_ns < low_ns || candidate.time_ns > high_ns) return;
        const MistypedTime time{point, i, candidate.time_ns, std::abs(other_ns - candidate.time_ns),
                                candidate.is_digit_lost};
        if (best && rank(*best, best_is_in_run) <= rank(time, candidate.is_in_run)) return;
        best = time;
        best_is_in_run = candidate.is_in_run;
      });
    };
    const std::int64_t before_ns = i > 0 ? points[i - 1].time_ns : -kNever;
    const std::int64_t after_ns = i + 2 < points.size() ? points[i + 2].time_ns : kNever;
    try_end(i, end_ns, std::max(before_ns + 1, end_ns - kLongestStepNs), end_ns - 1);
    try_end(i + 1, begin_ns, begin_ns + 1, std::min(after_ns - 1, begin_ns + kLongestStepNs));
    if (best) found.push_back(*best);
  }
  return found;
}

std::string_view to_text(Kind kind) {
  switch (kind) {
    case Kind::zero_everywhere: return "zero_everywhere";
    case Kind::before_capture: return "before_capture";
    case Kind::after_capture: return "after_capture";
    case Kind::held_gain: return "held_gain";
    case Kind::still_gain_not_positive: return "still_gain_not_positive";
    case Kind::still_gain_saturates: return "still_gain_saturates";
    case Kind::mistyped_time: return "mistyped_time";
    case Kind::missing_unit: return "missing_unit";
  }
  return {};
}

std::vector<FunctionFinding> check_domain(const GainFunction& function, const GainSummary& summary,
                                          const CheckedDomain& domain) {
  std::vector<FunctionFinding> findings;
  const std::string end = seconds_text(domain.duration_ns);
  if (summary.support_ns == 0 && domain.is_capture) {
    findings.push_back(
        {Kind::zero_everywhere,
         format("the function is zero everywhere in the capture (0 … {}); its pixels are 0", end),
         {}});
  } else if (summary.support_ns == 0) {
    findings.push_back({Kind::zero_everywhere, "the function is zero everywhere; its pixels are 0", {}});
  }
  if (summary.reaches_before_capture) {
    findings.push_back({Kind::before_capture,
                        "parts that are not zero lie before the capture's start and do not count",
                        first_outside(function, [](std::int64_t time_ns) { return time_ns < 0; })});
  }
  if (summary.reaches_after_capture) {
    findings.push_back(
        {Kind::after_capture,
         format("parts that are not zero lie after the capture's end at {} and do not count", end),
         first_outside(function, [&](std::int64_t time_ns) { return time_ns > domain.duration_ns; })});
  }
  if (auto held = held_finding(function, summary, domain)) findings.push_back(std::move(*held));
  return findings;
}

std::vector<FunctionFinding> check_function(const GainFunction& function, const GainSummary& summary,
                                            const CheckedDomain& domain) {
  std::vector<FunctionFinding> findings = check_domain(function, summary, domain);
  if (auto still_gain = still_gain_finding(summary)) findings.push_back(std::move(*still_gain));
  for (const MistypedTime& mistyped : mistyped_times(function)) {
    findings.push_back(mistyped_finding(function, mistyped));
  }
  return findings;
}

std::optional<FunctionFinding> check_units(const GainFunction& function, const GainSummary& summary,
                                           const CheckedDomain& domain) {
  constexpr std::int64_t kShare = 100'000;  // of the capture, and of a second: 10 us
  const std::int64_t last_ns = function.points().back().time_ns;
  const bool is_short = last_ns > 1 && last_ns < std::min(domain.duration_ns, kSecondNs) / kShare;
  if (!domain.is_capture || !is_short || summary.exposes_to_the_end) return std::nullopt;
  return FunctionFinding{Kind::missing_unit,
                         format("it ends {} ns after the start of a capture of {}; if its times were meant in "
                                "milliseconds, write {}ms",
                                last_ns, seconds_text(domain.duration_ns), last_ns),
                         function.points().size() - 1};
}

Interval meant_interval(const GainFunction& function, const GainSummary& summary) {
  const auto points = function.points();
  Interval meant = summary.live;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i + 1].time_ns != points[i].time_ns + 1) continue;
    if (points[i].gain == 0.0 && points[i].time_ns == summary.live.begin_ns) ++meant.begin_ns;
    if (points[i + 1].gain == 0.0 && points[i + 1].time_ns == summary.live.end_ns) --meant.end_ns;
  }
  return meant.empty() ? summary.live : meant;
}

std::optional<double> still_stops(const GainSummary& summary) {
  const double still_gain = summary.still_gain();
  return still_gain > 0.0 ? std::optional(std::log2(still_gain)) : std::nullopt;
}

}  // namespace nutik
