// From the words of a command line to a command and its options.
#pragma once

#include <span>
#include <string>

#include "app/command_line/command_table.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"

namespace nutik::app {

struct ParsedCommandLine {
  const Command* command = nullptr;
  Options options;
};

// Finds the command: the first word that is no option nor an option's value and is not behind `--`, where
// it is a command's name; otherwise the paper's shorthand, told from the options and operands. Throws
// UsageError with the right command where it makes no sense. Help and version are answered here, on
// stdout; the result's command is null then.
[[nodiscard]] ParsedCommandLine parse_command_line(std::span<const std::string> words);

// Whether an input is read from standard input. Throws UsageError where two would be.
bool reads_standard_input(const Options& options);

}  // namespace nutik::app
