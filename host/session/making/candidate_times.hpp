// Which times are tried for the named ones of gain functions.
#pragma once

#include <vector>

#include "capture/timeline.hpp"
#include "exposure/function_template.hpp"
#include "session/requests/wish.hpp"
#include "solve/time_search.hpp"

namespace nutik {

// For each named time, in the order of the template: in the steps that were stated, else a picture's time apart, or
// further where that would make more than 20,000 combinations of all; then times between them count, too. Throws
// UsageError where a time has no range, one that does not lie in the capture, or where steps make more than a million
// combinations.
[[nodiscard]] std::vector<CandidateTimes> candidate_times(const FunctionTemplate& functions,
                                                          const std::vector<StatedFreedom>& free,
                                                          const Timeline& timeline);

}  // namespace nutik
