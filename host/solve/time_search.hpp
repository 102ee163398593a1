// The times at which gains come nearest to wishes: every candidate is tried, and the search goes on round the best
// ones, down to the nanosecond. No candidate takes another look at the capture.
//
//   in:      candidates for each named time, and their distance where times between them count too
//   out:     the times and gains with the least cost; the earliest among equals
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solve/gain_search.hpp"

namespace nutik {

struct CandidateTimes {
  std::vector<std::int64_t> times_ns;  // increasing
  std::int64_t step_ns = 0;            // from one to the next where times between them count too; else 0
};

struct FoundTimes {
  std::vector<std::int64_t> times_ns;
  FoundGains found;
  std::uint64_t tried = 0;  // exposures
};

// Nothing if no candidates put the times of every function in order. Throws InputError if a function cannot be
// normalized with any that do. `search` is left at what was found; `progress` counts combinations of candidates.
[[nodiscard]] std::optional<FoundTimes> find_times(
    GainSearch& search, const std::vector<CandidateTimes>& candidates,
    const ReportedProgress& progress = {});

}  // namespace nutik
