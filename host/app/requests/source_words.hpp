// What the options say of a clip, and of what work may take, as the session's requests.
#pragma once

#include <string>

#include "app/command_line/options.hpp"
#include "session/memory_budget.hpp"
#include "session/source_request.hpp"

namespace nutik::app {

// Stated for --noise: measured on the clip itself.
inline constexpr std::string_view kAutomaticNoise = "auto";

// What was stated, as 500MB, 2GB or 1GiB; else half of the machine's memory. Throws UsageError where it is no size.
[[nodiscard]] MemoryBudget memory_budget(const Options& options);

// How the clip or capture of this name is to be read. Reads a noise file. Throws UsageError where a value makes no
// sense or describes a clip and this is a .tik, InputError where the noise file is wrong.
[[nodiscard]] SourceRequest source_request(const Options& options, const std::string& name);

// The same of a clip, whatever its name.
[[nodiscard]] SourceRequest clip_request(const Options& options, const std::string& name);

}  // namespace nutik::app
