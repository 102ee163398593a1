// The times at which gains come nearest to wishes: every candidate is tried, and round the best ones it goes on to the
// nanosecond. No candidate takes another look at the capture.
//
//   in:      for each named time its candidates, and how far apart they are where times between them count too
//   out:     the times and gains with the least cost; of several the earliest
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "solve/gain_search.hpp"

namespace nutik {

struct CandidateTimes {
  std::vector<std::int64_t> times_ns;  // increasing
  std::int64_t step_ns = 0;  // where times between them count too, how far it is from one to the next; else 0
};

struct FoundTimes {
  std::vector<std::int64_t> times_ns;
  FoundGains found;
  std::uint64_t tried = 0;  // exposures
};

// None where no candidates have the times of every function in order. Throws InputError where a function cannot be
// normalized with any that have. `search` is left at what was found. Progress
// counts combinations of candidates.
[[nodiscard]] std::optional<FoundTimes> find_times(
    GainSearch& search, const std::vector<CandidateTimes>& candidates,
    const std::function<void(std::uint64_t, std::uint64_t)>& progress = {});

}  // namespace nutik
