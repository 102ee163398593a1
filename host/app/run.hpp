// A command line, run: the one place that turns errors into messages and exit statuses.
#pragma once

#include <span>

namespace nutik::app {

struct ExitStatus {
  static constexpr int ok = 0, other = 1, usage = 2, input = 3, device = 4, output = 5, memory = 6, imprecise = 7,
                       signal = 128;
};

// What the program does with these words, of which the first is its own name.
int run(std::span<const char* const> words);
// The same of a process that does nothing else, whose signals and limits are set to that.
int run_process(std::span<const char* const> words);

}  // namespace nutik::app
