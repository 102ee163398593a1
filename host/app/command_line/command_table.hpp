// The commands: what each is called, what it takes and what it does.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "app/command_line/options.hpp"

namespace nutik::app {

enum class CommandId {
  encode,
  expose,
  info,
  devices,
  recover,
  batch,
  check,
  trace,
  mask,
  contact,
  activity,
  sweep,
  video,
  noise,
  shutter,
  again,
  validate
};

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

template <typename... Ids>
[[nodiscard]] constexpr CommandSet set_of(Ids... ids) {
  return (bit(ids) | ...);
}

[[nodiscard]] std::span<const Command> commands();
[[nodiscard]] const Command& command(CommandId id);
[[nodiscard]] const Command* find_command(std::string_view name);

}  // namespace nutik::app
