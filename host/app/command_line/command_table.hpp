// The commands: what each is called, what it takes and what it does.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "features/schema/command_id.hpp"
#include "features/schema/options.hpp"

namespace nutik::app {

// Returns the exit status; errors are thrown.
using Run = int(const Options& options);

// Where help lists a command.
inline constexpr std::string_view kCaptures = "Captures", kPictures = "Pictures and videos",
                                  kUnderstanding = "Finding the moment, masks, understanding",
                                  kOther = "Other";
inline constexpr std::string_view kCommandGroups[] = {kCaptures, kPictures, kUnderstanding, kOther};

struct Command {
  CommandId id;
  std::string_view name;
  std::string_view operands;  // as in a synopsis
  std::string_view summary;
  std::string_view examples;  // lines, each a command
  Run* run;
  std::string_view group = kOther;
  std::string_view old_name = {};  // in earlier versions: still read where no file has it, never shown
};

// The commands of the paper's forms, which need no name.
inline constexpr CommandId kShorthand[] = {CommandId::encode, CommandId::expose, CommandId::info};

[[nodiscard]] std::span<const Command> commands();
// The same, group by group.
[[nodiscard]] std::vector<const Command*> commands_of(std::string_view group);
[[nodiscard]] const Command& command(CommandId id);
[[nodiscard]] const Command* find_command(std::string_view name);

}  // namespace nutik::app
