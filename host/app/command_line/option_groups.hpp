// The rows of the option table, a function for each group of help, and the commands that share options.
#pragma once

#include <string_view>
#include <vector>

#include "app/command_line/option_table.hpp"

namespace nutik::app {

[[nodiscard]] std::vector<Option> source_options();
[[nodiscard]] std::vector<Option> exposure_options();
[[nodiscard]] std::vector<Option> computing_options();
[[nodiscard]] std::vector<Option> output_options();

using OptionGroup = std::vector<Option> (*)();
inline constexpr OptionGroup kOptionGroups[] = {source_options, exposure_options, computing_options,
                                                output_options};

inline constexpr CommandSet kAllCommands = ~CommandSet{0};
// Those that read a clip, and so take what describes it.
inline constexpr CommandSet kReadsClips =
    bit(CommandId::encode) | bit(CommandId::expose) | bit(CommandId::batch);
// Those that decode a clip, and so take what its codes are.
inline constexpr CommandSet kDecodesClips = kReadsClips | bit(CommandId::noise);
// Those that expose pictures with gain functions and a mask.
inline constexpr CommandSet kExposesFunctions = bit(CommandId::expose);
// Those that expose pictures at all, and so take what says how that is computed.
inline constexpr CommandSet kExposes = kExposesFunctions | bit(CommandId::batch);

// A row with a value, for the member of Options that holds it.
[[nodiscard]] inline Option valued(char short_name, std::string_view long_name, std::string_view value,
                                   std::string_view group, std::string_view help, CommandSet commands,
                                   std::optional<std::string> Options::*member) {
  return {short_name,
          long_name,
          value,
          group,
          help,
          commands,
          [member](Options& options, const std::string& text) { options.*member = text; }};
}

// A row without one.
[[nodiscard]] inline Option flag(char short_name, std::string_view long_name, std::string_view group,
                                 std::string_view help, CommandSet commands, bool Options::*member) {
  return {short_name, long_name, {}, group, help, commands, [member](Options& options, const std::string&) {
            options.*member = true;
          }};
}

}  // namespace nutik::app
