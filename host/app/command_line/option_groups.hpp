// The rows of the option table, a function for each group of help, and the commands that share options.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "app/command_line/option_table.hpp"

namespace nutik::app {

[[nodiscard]] std::vector<Option> source_options();
[[nodiscard]] std::vector<Option> exposure_options();
[[nodiscard]] std::vector<Option> mask_options();
[[nodiscard]] std::vector<Option> moment_options();
[[nodiscard]] std::vector<Option> video_options();
[[nodiscard]] std::vector<Option> computing_options();
[[nodiscard]] std::vector<Option> validation_options();
[[nodiscard]] std::vector<Option> output_options();

using OptionGroup = std::vector<Option> (*)();
inline constexpr OptionGroup kOptionGroups[] = {source_options,     exposure_options, video_options,
                                                mask_options,       moment_options,   computing_options,
                                                validation_options, output_options};

inline constexpr CommandSet kAllCommands = ~CommandSet{0};
// Those that read a clip, and so take what describes it.
inline constexpr CommandSet kReadsClips =
    set_of(CommandId::encode, CommandId::expose, CommandId::batch, CommandId::check, CommandId::trace,
           CommandId::mask, CommandId::contact, CommandId::activity, CommandId::sweep, CommandId::video,
           CommandId::validate);
// Those that decode a clip, and so take what its codes are.
inline constexpr CommandSet kDecodesClips = kReadsClips | set_of(CommandId::noise);
// Those of them that turn it into a capture, or expose it.
inline constexpr CommandSet kEncodesClips = kReadsClips & ~set_of(CommandId::check);
// Those that take gain functions.
inline constexpr CommandSet kTakesFunctions = set_of(CommandId::expose, CommandId::check, CommandId::trace,
                                                     CommandId::sweep, CommandId::video, CommandId::validate);
inline constexpr CommandSet kTakesMasks = kTakesFunctions | set_of(CommandId::activity);
// Those that take a plain interval.
inline constexpr CommandSet kTakesIntervals =
    set_of(CommandId::expose, CommandId::trace, CommandId::mask, CommandId::contact, CommandId::sweep,
           CommandId::validate);
// Those that shape and weigh what they expose.
inline constexpr CommandSet kShapesExposures =
    set_of(CommandId::expose, CommandId::trace, CommandId::sweep, CommandId::video, CommandId::validate);
// Those that expose pictures, and so take what says how that is computed.
inline constexpr CommandSet kExposes = set_of(CommandId::expose, CommandId::batch, CommandId::mask,
                                              CommandId::contact, CommandId::sweep, CommandId::video);
// Those whose pictures may hold light below 0.
inline constexpr CommandSet kExposesFreely =
    set_of(CommandId::expose, CommandId::contact, CommandId::sweep, CommandId::video);
// Those that lay pictures out on a sheet.
inline constexpr CommandSet kMakesSheets = set_of(CommandId::contact, CommandId::sweep);
// Those that can answer in JSON.
inline constexpr CommandSet kAnswersInJson =
    set_of(CommandId::check, CommandId::trace, CommandId::mask, CommandId::contact, CommandId::activity,
           CommandId::sweep, CommandId::encode, CommandId::expose, CommandId::info, CommandId::devices,
           CommandId::recover, CommandId::noise, CommandId::batch, CommandId::video, CommandId::validate);

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
          [member](Options& options, const std::string& text) { options.*member = text; },
          member};
}

// That row, where its values are known.
[[nodiscard]] inline Option one_of(Option option, std::vector<std::string_view> choices) {
  option.choices = std::move(choices);
  return option;
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
  return {0, long_name, value, group, help, commands, {}, nullptr, true};
}

}  // namespace nutik::app
