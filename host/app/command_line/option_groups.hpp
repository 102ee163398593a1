// The rows of the option table, a function for each group of help, and the commands that share options.
#pragma once

#include <string_view>
#include <vector>

#include "app/command_line/option_table.hpp"

namespace nutik::app {

[[nodiscard]] std::vector<Option> source_options();
[[nodiscard]] std::vector<Option> exposure_options();
[[nodiscard]] std::vector<Option> mask_options();
[[nodiscard]] std::vector<Option> moment_options();
[[nodiscard]] std::vector<Option> computing_options();
[[nodiscard]] std::vector<Option> output_options();

using OptionGroup = std::vector<Option> (*)();
inline constexpr OptionGroup kOptionGroups[] = {source_options, exposure_options,  mask_options,
                                                moment_options, computing_options, output_options};

inline constexpr CommandSet kAllCommands = ~CommandSet{0};
// Those that read a clip, and so take what describes it.
inline constexpr CommandSet kReadsClips =
    bit(CommandId::encode) | bit(CommandId::expose) | bit(CommandId::batch) | bit(CommandId::check) |
    bit(CommandId::trace) | bit(CommandId::mask) | bit(CommandId::contact) | bit(CommandId::activity) |
    bit(CommandId::sweep);
// Those of them that turn it into a capture, or write something at all.
inline constexpr CommandSet kEncodesClips = kReadsClips & ~bit(CommandId::check);
// Those that expose pictures with gain functions and a mask.
inline constexpr CommandSet kExposesFunctions = bit(CommandId::expose) | bit(CommandId::sweep);
// Those that expose a plain interval.
inline constexpr CommandSet kExposesIntervals =
    kExposesFunctions | bit(CommandId::mask) | bit(CommandId::contact);
// Those that follow an exposure, or look at functions and masks alone.
inline constexpr CommandSet kTakesExposures = kExposesFunctions | bit(CommandId::trace);
inline constexpr CommandSet kTakesFunctions = kTakesExposures | bit(CommandId::check);
// Those that print for a script where they are told to.
inline constexpr CommandSet kAnswersInJson = bit(CommandId::check) | bit(CommandId::trace) |
                                             bit(CommandId::mask) | bit(CommandId::contact) |
                                             bit(CommandId::activity) | bit(CommandId::sweep);
// Those that expose pictures at all, and so take what says how that is computed.
inline constexpr CommandSet kExposes = kExposesIntervals | bit(CommandId::batch);
// Those that lay pictures out on a sheet.
inline constexpr CommandSet kMakesSheets = bit(CommandId::contact) | bit(CommandId::sweep);

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

// A row that may be given again and again: what it says stands in Options::said alone. `value` is empty for
// a flag.
[[nodiscard]] inline Option step(std::string_view long_name, std::string_view value, std::string_view group,
                                 std::string_view help, CommandSet commands) {
  return {0, long_name, value, group, help, commands, {}, commands};
}

}  // namespace nutik::app
