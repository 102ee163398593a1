// The times at which a camera's exposures begin and end, as places to go to and to snap to.
#pragma once

#include <cstdint>

#include "capture/timeline.hpp"

namespace nutik::studio {

// The begin or end of an exposure that is nearest to a time, or the capture's end.
[[nodiscard]] std::int64_t nearest_sample_edge(std::int64_t time_ns, const Timeline& timeline);

// The time that lies as far behind the start of a sample as `time_ns` behind the start of its own, `steps` samples later
// or earlier; beyond the capture samples go on at its mean rate.
[[nodiscard]] std::int64_t samples_later(std::int64_t time_ns, std::int64_t steps, const Timeline& timeline);

}  // namespace nutik::studio
