// Errors and notes in the words of a client: libraries say what is wrong and what helps, and which options that are is
// read from the schema.
#include <algorithm>

#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "session/text/shell_text.hpp"
#include "tik/reader.hpp"

namespace nutik {
namespace {

// `unseen hold`: an option by its long name, and its value. Empty where there is no such option.
std::string written(std::string_view stated, Dialect dialect) {
  const std::size_t blank = std::min(stated.find(' '), stated.size());
  const Option* const option = find_option(stated.substr(0, blank));
  return option == nullptr || option->long_name.empty()
             ? ""
             : option->written(dialect, stated.substr(std::min(blank + 1, stated.size())));
}

// Advice, with the options that stand in it between backquotes. A backquote may also be part of a file's name.
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

}  // namespace

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
