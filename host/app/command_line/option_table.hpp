// The one table of options: what the command line is parsed with, and what help shows.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line/command_table.hpp"
#include "app/command_line/options.hpp"

namespace nutik::app {

struct Option {
  char short_name;  // 0: none
  std::string_view long_name;
  std::string_view value;  // as in help, a word for each that is needed; empty: a flag
  std::string_view group;
  std::string_view help;
  CommandSet commands;
  // For an option of one value. What an option of several was given stands in Options::said alone.
  std::function<void(Options& options, const std::string& value)> set;
  std::optional<std::string> Options::*member = nullptr;  // that holds its value
  bool is_repeatable = false;
  // The values it knows; one that ends with `:` goes on as a person likes, `gamma:2.2`. Empty: told by `value`.
  std::vector<std::string_view> choices = {};

  // How many words its value takes.
  [[nodiscard]] std::size_t word_count() const;

  // `fn` where `value` is FILE.fn; empty where no kind of file is named.
  [[nodiscard]] std::string_view file_extension() const;
  // Whether a value is a file's name.
  [[nodiscard]] bool takes_file() const;

  // `-f`, or `--fps` where it has no short name.
  [[nodiscard]] std::string display_name() const;
};

// Group by group, as help shows them.
[[nodiscard]] std::span<const Option> options();
// By `--fps` or `-f` without its dashes; null where there is none. Several rows may share a name, for commands
// that mean different things by it: as many words belong to it in each.
[[nodiscard]] const Option* find_option(std::string_view long_name);
[[nodiscard]] const Option* find_option(char short_name);
// The row of that name for this command.
[[nodiscard]] const Option* option_of(const Command& command, std::string_view long_name);
// Those of a command.
[[nodiscard]] std::vector<const Option*> options_of(const Command& command);

}  // namespace nutik::app
