#include "app/command_line/option_table.hpp"

#include <algorithm>
#include <vector>

#include "app/command_line/option_groups.hpp"

namespace nutik::app {

std::string Option::display_name() const {
  return short_name != 0 ? std::string{'-', short_name} : "--" + std::string(long_name);
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

const Option* find_option(char short_name) {
  const auto found = std::find_if(options().begin(), options().end(), [&](const Option& option) {
    return option.short_name != 0 && option.short_name == short_name;
  });
  return found == options().end() ? nullptr : &*found;
}

}  // namespace nutik::app
