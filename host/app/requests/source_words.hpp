// What the options say of a clip, and of how the work is done, as the session's requests.
#pragma once

#include "app/command_line/options.hpp"
#include "session/memory_budget.hpp"

namespace nutik::app {

// What was stated, as 500MB, 2GB or 1GiB; else half of the machine's memory. Throws UsageError where it is no size.
[[nodiscard]] MemoryBudget memory_budget(const Options& options);

}  // namespace nutik::app
