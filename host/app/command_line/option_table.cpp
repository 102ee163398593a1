#include "app/command_line/option_table.hpp"

#include <algorithm>

#include "app/text/text_table.hpp"

namespace nutik::app {
namespace {

template <typename Wanted>
const Option* first_option(Wanted wanted) {
  const auto found = std::ranges::find_if(options(), wanted);
  return found == options().end() ? nullptr : &*found;
}

}  // namespace

std::string Option::display_name() const { return short_name != 0 ? std::string{'-', short_name} : name(); }

std::size_t Option::word_count() const {
  return value.empty() ? 0 : 1 + static_cast<std::size_t>(std::ranges::count(value, ' '));
}

std::vector<std::string> Option::choices() const { return parts_of(choice_list, ' '); }

bool Option::knows(std::string_view stated) const {
  return std::ranges::any_of(choices(), [&](const std::string& choice) {
    return stated == choice || (choice.ends_with(':') && stated.starts_with(choice));
  });
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

const std::string* Option::stated(const Options& options) const {
  const auto* holder = std::get_if<Options::Value Options::*>(&member);
  return holder != nullptr && options.**holder ? &*(options.**holder) : nullptr;
}

bool Option::is_in(const Options& options) const {
  const auto* holder = std::get_if<bool Options::*>(&member);
  return holder != nullptr ? options.**holder : stated(options) != nullptr;
}

void Option::copy(Options& options, const Options& other) const {
  if (const auto* value_holder = std::get_if<Options::Value Options::*>(&member)) {
    options.** value_holder = other.**value_holder;
  } else if (const auto* flag_holder = std::get_if<bool Options::*>(&member)) {
    options.** flag_holder = other.**flag_holder;
  }
}

const Option* find_option(std::string_view long_name) {
  return first_option([&](const Option& option) { return option.long_name == long_name; });
}

const Option* find_option(char short_name) {
  return first_option(
      [&](const Option& option) { return option.short_name != 0 && option.short_name == short_name; });
}

const Option* option_of(const Command& command, std::string_view long_name) {
  return first_option(
      [&](const Option& option) { return option.long_name == long_name && option.is_of(command.id); });
}

std::vector<const Option*> options_of(const Command& command) {
  std::vector<const Option*> found;
  for (const Option& option : options()) {
    if (option.is_of(command.id)) found.push_back(&option);
  }
  return found;
}

}  // namespace nutik::app
