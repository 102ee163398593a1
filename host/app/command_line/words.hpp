// The words of a command line, told apart: command, options with their values, operands.
//
// This needs no command, for an option takes as many words in each. Which row of its name is meant depends on it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/command_line/command_table.hpp"
#include "session/schema/option.hpp"

namespace nutik::app {

struct Given {
  const Option* option;
  std::string name;  // as it was written: `-f`
  std::vector<std::string> words;
};

struct Words {
  const Command* command = nullptr;   // the first operand, where it is a command's name and not behind `--`
  std::vector<std::string> operands;  // the others
  std::vector<Given> given;           // in their order
  bool unfinished = false;            // the last option needs more words
  bool help = false;
  bool version = false;

  // Throws UsageError for an option that there is not, and for a value that is none (value_check.hpp).
  static Words of(std::span<const std::string> words);
};

}  // namespace nutik::app
