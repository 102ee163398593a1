// The commands: what each is called, what it takes and what it does.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "features/schema/command_id.hpp"
#include "features/schema/options.hpp"

namespace nutik::app {

// Each returns the exit status; errors are thrown. They are defined in app/commands.
using Run = int(const Options& options);

Run run_activity, run_again, run_batch, run_check, run_completion, run_contact, run_devices, run_encode,
    run_expose, run_info, run_join, run_man, run_mask, run_noise, run_plate, run_recover, run_retime, run_series, run_shutter,
    run_solve, run_study, run_sweep, run_thumbnail, run_trace, run_validate, run_video;

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
};

// The commands of the paper's forms, which need no name.
inline constexpr CommandId kShorthand[] = {CommandId::encode, CommandId::expose, CommandId::info};

[[nodiscard]] std::span<const Command> commands();
// The same, group by group.
[[nodiscard]] std::vector<const Command*> commands_of(std::string_view group);
[[nodiscard]] const Command& command(CommandId id);
[[nodiscard]] const Command* find_command(std::string_view name);

}  // namespace nutik::app
