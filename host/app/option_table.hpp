// The one table of options and commands: what the command line is parsed with, and what help shows.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "app/options.hpp"

namespace nutik::app {

enum class CommandId { encode, expose, info, devices, recover };

struct Command {
  CommandId id;
  std::string_view name;
  std::string_view operands;  // as in a synopsis
  std::string_view summary;
  std::string_view examples;  // lines, each a command
  int (*run)(const Options& options);
};

// Commands that an option belongs to, as bits.
using CommandSet = std::uint32_t;
[[nodiscard]] constexpr CommandSet bit(CommandId id) { return 1u << static_cast<unsigned>(id); }

struct Option {
  char short_name;  // 0: none
  std::string_view long_name;
  std::string_view value;  // as in help; empty: a flag
  std::string_view group;
  std::string_view help;
  CommandSet commands;
  std::function<void(Options& options, const std::string& value)> set;

  // `-f`, or `--fps` where it has no short name.
  [[nodiscard]] std::string display_name() const;
};

[[nodiscard]] std::span<const Command> commands();
[[nodiscard]] const Command& command(CommandId id);
[[nodiscard]] const Command* find_command(std::string_view name);

[[nodiscard]] std::span<const Option> options();
// By `--fps` or `-f` without its dashes; null where there is none.
[[nodiscard]] const Option* find_option(std::string_view long_name);
[[nodiscard]] const Option* find_option(char short_name);

}  // namespace nutik::app
