#include "features/schema/option.hpp"

#include <algorithm>
#include <utility>

#include "capture/format.hpp"
#include "capture/text.hpp"
#include "session/text/shell_text.hpp"
#include "tik/reader.hpp"

namespace nutik {
namespace {

template <typename Wanted>
const Option* first_option(Wanted wanted) {
  const auto found = std::ranges::find_if(schema(), wanted);
  return found == schema().end() ? nullptr : &*found;
}

}  // namespace

std::string Option::display_name() const { return short_name != 0 ? std::string{'-', short_name} : name(); }

std::size_t Option::word_count() const {
  return value.empty() ? 0 : 1 + static_cast<std::size_t>(std::ranges::count(value, ' '));
}

std::vector<std::string> Option::choices() const { return parts_of(choice_list, ' '); }

bool Option::knows(std::string_view word) const {
  return std::ranges::any_of(choices(), [&](const std::string& choice) {
    return word == choice || (choice.ends_with(':') && word.starts_with(choice));
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
  return is_in(options) && !is_flag() ? &options.find(long_name)->words.front() : nullptr;
}

bool Option::is_in(const Options& options) const {
  const Said* const said = take != nullptr ? options.find(long_name) : nullptr;
  return said != nullptr && said->row->take == take;
}

void Option::state(Options& options, std::string_view what, std::vector<std::string> words) const {
  if (take != nullptr) {
    if (!is_flag() && options.has(long_name)) throw UsageError(display_name() + " is given twice");
    static const std::string kFlag;
    take(options, *this, what, is_flag() ? kFlag : words.front());
  }
  options.said.push_back({long_name, std::move(words), this});
}

void Option::restate(Options& options, std::vector<std::string> words) const {
  std::erase_if(options.said, [&](const Said& said) { return said.option == long_name; });
  state(options, name(), std::move(words));
}

std::string Option::written(Dialect dialect, std::string_view word) const {
  if (dialect == Dialect::command_line) return name() + (word.empty() ? "" : " ") + std::string(word);
  std::string argument(python.empty() ? long_name : python);
  std::ranges::replace(argument, '-', '_');
  if (!word.empty()) return format("{}='{}'", argument, word);
  return argument + (is_flag() ? "=True" : "=");
}

const Option* find_option(std::string_view long_name) {
  return first_option([&](const Option& option) { return option.is_called(long_name); });
}

const Option* find_option(char short_name) {
  return first_option(
      [&](const Option& option) { return option.short_name != 0 && option.short_name == short_name; });
}

const Option* option_of(CommandId command, std::string_view long_name) {
  return first_option(
      [&](const Option& option) { return option.is_called(long_name) && option.is_of(command); });
}

const Option* option_of_argument(CommandId command, std::string_view name) {
  std::string old_name(name);
  std::ranges::replace(old_name, '_', '-');
  return first_option([&](const Option& option) {
    const std::string written = option.written(Dialect::python);
    const bool is_old = old_name == option.old_name && !name.empty();
    return option.is_of(command) && (is_old || written.substr(0, written.find('=')) == name);
  });
}

std::vector<const Option*> options_of(CommandId command) {
  std::vector<const Option*> found;
  for (const Option& option : schema()) {
    if (option.is_of(command)) found.push_back(&option);
  }
  return found;
}

Options without(const Options& options, Scope scope) {
  Options others;
  others.program = options.program;
  others.operands = options.operands;
  for (const Said& said : options.said) {
    if (said.row->scope != scope) said.row->state(others, said.row->name(), said.words);
  }
  return others;
}

// Errors and notes in the words of a client: libraries say what is wrong and what helps, and which options that are is
// read from the schema.

namespace {

// `unseen hold`: an option by its long name, and its value. Empty where there is no such option.
std::string written(std::string_view stated, Dialect dialect) {
  const std::size_t blank = std::min(stated.find(' '), stated.size());
  const Option* const option = find_option(stated.substr(0, blank));
  return option == nullptr || option->long_name.empty()
             ? ""
             : option->written(dialect, stated.substr(std::min(blank + 1, stated.size())));
}

}  // namespace

// A backquote may also be part of a file's name.
std::string in_words(std::string_view advice, Dialect dialect) {
  std::string text;
  while (true) {
    const std::size_t begin = advice.find('`');
    const std::size_t end = begin == advice.npos ? advice.npos : advice.find('`', begin + 1);
    if (end == advice.npos) return text + std::string(advice);
    const std::string option = written(advice.substr(begin + 1, end - begin - 1), dialect);
    const std::size_t taken = option.empty() ? begin + 1 : end + 1;
    text += option.empty() ? advice.substr(0, taken) : std::string(advice.substr(0, begin)) + option;
    advice.remove_prefix(taken);
  }
}

std::string written(Setting setting, Dialect dialect) {
  if (setting == Setting::automatic_noise) return written("noise auto", dialect);
  for (const Option& option : schema()) {
    if (option.setting == setting) return option.written(dialect, setting == Setting::unmapped ? "zero" : "");
  }
  return {};
}

std::string written(const std::vector<Setting>& settings, Dialect dialect) {
  std::string text;
  for (const Setting setting : settings) text += (text.empty() ? " (" : ", ") + written(setting, dialect);
  return text.empty() ? text : text + ")";
}

std::string message_text(const std::exception& error, Dialect dialect) {
  const std::string message = error.what();
  if (const auto* damaged = dynamic_cast<const tik::Recoverable*>(&error)) {
    return format("{}; save what is whole with: nutik-cl recover {} -o recovered.tik", message,
                  shell_word(damaged->name));
  }
  const auto* known = dynamic_cast<const Error*>(&error);
  if (known == nullptr) return message;
  return (message == known->advice() ? "" : message) + in_words(known->advice(), dialect) +
         written(known->settings(), dialect);
}

std::vector<std::string> note_texts(const std::vector<Note>& notes, Dialect dialect) {
  std::vector<std::string> texts;
  for (const Note& note : notes) texts.push_back(note.text + written(note.settings, dialect));
  return texts;
}

}  // namespace nutik
