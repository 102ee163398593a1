// The words of a command line, told apart: command, options with their values, operands.
//
// This needs no command, for an option takes as many words in each. Which row of its name is meant depends on it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line/command_table.hpp"
#include "features/schema/option.hpp"

namespace nutik::app {

// Throws UsageError where a value is most likely a mistyped one of the option's choices; `what` says what it is.
void check_choice(std::string_view what, const std::string& value, const Option& option);

// An option that was found, and its words.
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
  std::string topic = {};  // of help: --help=all
  bool is_help_word = false;  // `help`, and what follows is a command
  bool version = false;

  // Throws UsageError for an option that there is not, and for a value that cannot be what it takes.
  static Words of(std::span<const std::string> words);
};

}  // namespace nutik::app
