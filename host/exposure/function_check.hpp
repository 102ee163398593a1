// What is suspicious about a gain function that breaks no rule of the format.
//
//   in:      a function, its summary, and the domain that both are meant on
//   out:     findings, each a sentence for a person with the way out, and the control point it is about
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exposure/gain_function.hpp"

namespace nutik {

// Times in which a digit was probably lost, or typed once too often.
//
// A step is written as two control points at most 1 µs apart. Lose a digit of the first, and the step becomes
// a ramp that starts far too early, without any rule of the format being broken: the printed Figure 14 has
// [100000000:1], [1000000002:-25]. So a ramp is suspicious if one digit more or one less, anywhere in one of
// its two times, makes it a step again with all times still in order. Every digit whose loss
// turns a step into a ramp is found this way, except a first one before zeros, whose loss leaves zeros to be
// seen at the front. Ramps between times of whole milliseconds are never suspicious: 0.6 s to 0.8 s, or 0.1 s
// to 1 s, where one more zero would put both points at one time.
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

struct FunctionFinding {
  enum class Kind {
    zero_everywhere,  // within the domain
    before_capture,   // parts that are not zero and do not count
    after_capture,
    held_gain,                // a held end that exposes
    still_gain_not_positive,  // still scenes come out black
    still_gain_saturates,     // and white
    mistyped_time,
    missing_unit,  // all times are nanoseconds near the start of a long capture
  };

  Kind kind;
  std::string message;
  std::optional<std::size_t> point;  // of the function's control points
};

// `still_gain_saturates`: the name for scripts.
[[nodiscard]] std::string_view to_text(FunctionFinding::Kind kind);

// Where a function is looked at: a capture, or [0, duration_ns] as a stand-in for one.
struct CheckedDomain {
  std::int64_t duration_ns = 0;
  bool is_capture = true;
};

// What the function and the domain have to do with each other: the first four kinds. Every exposure warns
// of these.
[[nodiscard]] std::vector<FunctionFinding> check_domain(const GainFunction& function,
                                                        const GainSummary& summary,
                                                        const CheckedDomain& domain);

// All kinds, but that of units.
[[nodiscard]] std::vector<FunctionFinding> check_function(const GainFunction& function,
                                                          const GainSummary& summary,
                                                          const CheckedDomain& domain);

// Few people count in nanoseconds: [400:1] may stand for 400 ms.
[[nodiscard]] std::optional<FunctionFinding> check_units(const GainFunction& function, const GainSummary& summary,
                                                         const CheckedDomain& domain);

// The live interval without the steps of 1 ns at its ends, which stand for jumps: what a person means who counts the
// samples that a function exposes. A function that is nothing but such steps keeps them.
[[nodiscard]] Interval meant_interval(const GainFunction& function, const GainSummary& summary);

// How many stops a still scene is brighter than in one sample: log2 of the still gain. None where that is
// not positive.
[[nodiscard]] std::optional<double> still_stops(const GainSummary& summary);

}  // namespace nutik
