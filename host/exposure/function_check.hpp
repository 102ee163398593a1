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

struct FunctionFinding {
  enum class Kind {
    zero_everywhere,  // within the domain
    before_capture,   // parts that are not zero and do not count
    after_capture,
    held_gain,                // a held end that exposes
    still_gain_not_positive,  // still scenes come out black
    still_gain_saturates,     // and white
    mistyped_time,
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

// All kinds.
[[nodiscard]] std::vector<FunctionFinding> check_function(const GainFunction& function,
                                                          const GainSummary& summary,
                                                          const CheckedDomain& domain);

// The live interval without the steps of 1 ns at its ends, which stand for jumps: what a person means who counts the
// samples that a function exposes. A function that is nothing but such steps keeps them.
[[nodiscard]] Interval meant_interval(const GainFunction& function, const GainSummary& summary);

// How many stops a still scene is brighter than in one sample: log2 of the still gain. None where that is
// not positive.
[[nodiscard]] std::optional<double> still_stops(const GainSummary& summary);

}  // namespace nutik
