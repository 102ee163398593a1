#include "app/command_line/option_table.hpp"

#include <algorithm>
#include <vector>

#include "app/command_line/option_groups.hpp"

namespace nutik::app {

std::string Option::display_name() const {
  return short_name != 0 ? std::string{'-', short_name} : "--" + std::string(long_name);
}

std::string_view Option::file_extension() const {
  const auto dot = value.rfind('.');
  if (dot == std::string_view::npos || dot + 1 == value.size()) return {};
  const std::string_view extension = value.substr(dot + 1);
  const bool is_extension = std::ranges::all_of(extension, [](char c) { return c >= 'a' && c <= 'z'; });
  return is_extension ? extension : std::string_view();
}

bool Option::takes_file() const {
  return value.starts_with("FILE") || value.starts_with("CLIP") || value.starts_with("PICTURE") ||
         !file_extension().empty();
}

std::size_t Option::word_count() const {
  return value.empty() ? 0 : 1 + static_cast<std::size_t>(std::count(value.begin(), value.end(), ' '));
}

std::span<const Option> options() {
  static const std::vector<Option> table = [] {
    std::vector<Option> all;
    for (const OptionGroup group : kOptionGroups) {
      for (Option& option : group()) all.push_back(std::move(option));
    }
    return all;
  }();
  return table;
}

const Option* find_option(std::string_view long_name) {
  const auto found = std::find_if(options().begin(), options().end(),
                                  [&](const Option& option) { return option.long_name == long_name; });
  return found == options().end() ? nullptr : &*found;
}

const Option* option_of(const Command& command, std::string_view long_name) {
  const auto found = std::find_if(options().begin(), options().end(), [&](const Option& option) {
    return option.long_name == long_name && (option.commands & bit(command.id)) != 0;
  });
  return found == options().end() ? nullptr : &*found;
}

std::vector<const Option*> options_of(const Command& command) {
  std::vector<const Option*> found;
  for (const Option& option : options()) {
    if ((option.commands & bit(command.id)) != 0) found.push_back(&option);
  }
  return found;
}

const Option* find_option(char short_name) {
  const auto found = std::find_if(options().begin(), options().end(), [&](const Option& option) {
    return option.short_name != 0 && option.short_name == short_name;
  });
  return found == options().end() ? nullptr : &*found;
}

}  // namespace nutik::app
