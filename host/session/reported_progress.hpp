// Progress of what takes long, told to whoever asked for it.
#pragma once

#include <cstdint>
#include <functional>

namespace nutik {

// Called with how many steps are done of how many, 0 where that is not known, on the thread that does the work. May
// be empty. What it throws ends the work and comes back to the caller.
using ReportedProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

}  // namespace nutik
