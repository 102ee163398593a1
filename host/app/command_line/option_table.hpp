// The one table of options: what the command line is parsed with, and what help shows.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "app/command_line/command_table.hpp"
#include "app/command_line/options.hpp"

namespace nutik::app {

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

// Group by group, as help shows them.
[[nodiscard]] std::span<const Option> options();
// By `--fps` or `-f` without its dashes; null where there is none.
[[nodiscard]] const Option* find_option(std::string_view long_name);
[[nodiscard]] const Option* find_option(char short_name);

}  // namespace nutik::app
