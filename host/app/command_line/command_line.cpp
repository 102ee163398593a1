#include "app/command_line/command_line.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/command_line/help.hpp"
#include "app/command_line/suggestion.hpp"
#include "app/command_line/value_check.hpp"
#include "app/input/standard_input.hpp"
#include "app/text/shell_text.hpp"
#include "session/error.hpp"
#include "session/format.hpp"

namespace nutik::app {
namespace {

// An option as it was met. Which row of its name is meant depends on the command.
struct Given {
  const Option* option;
  std::vector<std::string> words;
};

// The words of a command line, told apart. This needs no command: an option takes as many words in each.
class Words {
 public:
  explicit Words(std::span<const std::string> words) : words_(words) {
    while (at_ < words_.size()) {
      const std::string& word = words_[at_++];
      if (word == "--") {
        operands.insert(operands.end(), words_.begin() + static_cast<std::ptrdiff_t>(at_), words_.end());
        return;
      }
      if (word == "--help" || word == "-h") {
        help = true;
      } else if (word == "--version") {
        version = true;
      } else if (word.starts_with("--")) {
        take_long(word);
      } else if (word.size() > 1 && word[0] == '-') {
        take_short(word);
      } else {
        take_operand(word);
      }
    }
  }

  const Command* command = nullptr;   // the first operand, where it is a command's name and not behind `--`
  std::vector<std::string> operands;  // the others
  std::vector<Given> given;
  bool help = false;
  bool version = false;

 private:
  void take_operand(const std::string& word) {
    if (command == nullptr && operands.empty()) {
      command = find_command(word);
      if (command != nullptr) return;
    }
    operands.push_back(word);
  }

  void take_long(const std::string& word) {
    const auto equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const Option* option = find_option(std::string_view(name).substr(2));
    if (option == nullptr) fail_unknown(name);
    if (equals == std::string::npos) return take(*option, name);
    take(*option, name, word.substr(equals + 1));
    check_choice(name, given.back().words.front(), *option);
  }

  // Flags may stand together, and the last letter may take a value: -qo out.png, -k trail.fn, -f120.
  void take_short(const std::string& word) {
    for (std::size_t letter = 1; letter < word.size(); ++letter) {
      const std::string name{'-', word[letter]};
      const Option* option = find_option(word[letter]);
      if (option == nullptr) fail_unknown(name);
      const std::string rest = word.substr(letter + 1);
      if (option->is_flag() || rest.empty()) {
        take(*option, name);
      } else {
        return take(*option, name, rest);
      }
    }
  }

  // The words of an option, the first of which may have stood in the same word as its name.
  void take(const Option& option, const std::string& name, const std::optional<std::string>& first = {}) {
    Given& said = given.emplace_back(&option, std::vector<std::string>());
    if (option.is_flag()) {
      if (first) throw UsageError(format("{} takes no value", option.display_name()));
      return;
    }
    if (first) said.words.push_back(*first);
    while (said.words.size() < option.word_count()) {
      if (at_ == words_.size()) {
        throw UsageError(format("{} needs {}: {} {}", name,
                                option.word_count() == 1 ? "a value" : "more words", name, option.value));
      }
      said.words.push_back(words_[at_++]);
    }
    if (!first && option.word_count() == 1) check_value(option, name, said.words.front());
  }

  // Suggests options of the command that is named, if any, before those of others.
  [[noreturn]] void fail_unknown(const std::string& name) const {
    const auto named =
        std::ranges::find_if(words_, [](const std::string& each) { return find_command(each) != nullptr; });
    std::vector<std::string> known{"--help", "--version"};
    if (named != words_.end()) {
      for (const Option* option : options_of(*find_command(*named))) known.push_back(option->name());
      if (const std::string suggestion = did_you_mean(name, known); !suggestion.empty())
        throw UsageError(format("there is no option {}{}; see nutik-cl {} --help", name, suggestion, *named));
    }
    for (const Option& option : options()) known.push_back(option.name());
    throw UsageError(format("there is no option {}{}; see nutik-cl --help", name, did_you_mean(name, known)));
  }

  std::span<const std::string> words_;
  std::size_t at_ = 0;
};

// A first word that names no file and looks like no file's name was meant as a command.
void fail_misspelt_command(const std::string& word) {
  std::error_code error;
  const bool is_word = word.find_first_of("./*?%[") == std::string::npos;
  if (!is_word || std::filesystem::exists(word, error)) return;
  std::vector<std::string> known;
  for (const Command& command : commands()) known.push_back(std::string(command.name));
  throw UsageError(
      format("there is no file and no command '{}'{}; see nutik-cl --help", word, did_you_mean(word, known)));
}

// Whether an option says what is exposed, which encoding has no use for.
bool implies_exposure(const Given& given) {
  const Option* option = option_of(command(CommandId::expose), given.option->long_name);
  return option != nullptr && !option->is_of(CommandId::encode) &&
         (option->scope == Scope::exposure || option->scope == Scope::series);
}

// The paper's forms: no command, only what belongs to it.
const Command& shorthand(const Words& words) {
  if (std::ranges::any_of(words.given, implies_exposure)) return command(CommandId::expose);
  if (words.operands.empty()) throw UsageError("a clip or a capture is missing: nutik-cl clip.mp4 clip.tik");
  const std::string& first = words.operands.front();
  fail_misspelt_command(first);
  const auto is_given = [&](std::string_view name) {
    return std::ranges::any_of(words.given,
                               [&](const Given& given) { return given.option->long_name == name; });
  };
  if (words.operands.size() > 1 || is_given("output")) return command(CommandId::encode);
  if (!first.ends_with(".tik")) {
    const std::string stem = std::filesystem::path(first).stem().string();
    throw UsageError(
        format("the output is missing: nutik-cl {} {}", shell_word(first), shell_word(stem + ".tik")));
  }
  if (words.given.empty() || (words.given.size() == 1 && is_given("quiet"))) return command(CommandId::info);
  throw UsageError(
      format("what should be done with {}? To expose a picture: nutik-cl --start 0s "
             "--exposure 10ms {} picture.png",
             first, shell_word(first)));
}

[[noreturn]] void fail_other_command(const Option& option, const Command& command) {
  std::string takers;
  for (const Command& other : commands()) {
    if (option_of(other, option.long_name) == nullptr) continue;
    takers += format("{}{}", takers.empty() ? "" : ", ", other.name);
  }
  throw UsageError(
      format("{} does not go with {}; it is an option of: {}", option.display_name(), command.name, takers));
}

Options options_for(const Command& command, Words words) {
  Options options;
  options.operands = std::move(words.operands);
  for (Given& given : words.given) {
    const Option* option = option_of(command, given.option->long_name);
    if (option == nullptr) fail_other_command(*given.option, command);
    if (const auto* flag = std::get_if<bool Options::*>(&option->member)) {
      options.** flag = true;
    } else if (const auto* value = std::get_if<std::optional<std::string> Options::*>(&option->member)) {
      if (options.**value) throw UsageError(format("{} is given twice", option->display_name()));
      options.** value = given.words.front();
    }
    options.said.push_back({option->long_name, std::move(given.words)});
  }
  return options;
}

}  // namespace

ParsedCommandLine parse_command_line(std::span<const std::string> words) {
  Words found(words);
  if (found.version) {
    print_version();
    return {};
  }
  if (found.help) {
    found.command != nullptr ? print_command_help(*found.command) : print_help();
    return {};
  }
  if (words.empty()) {
    throw UsageError("say what to do: nutik-cl clip.mp4 clip.tik encodes a clip; nutik-cl --help says more");
  }
  const Command& chosen = found.command != nullptr ? *found.command : shorthand(found);
  ParsedCommandLine parsed{&chosen, options_for(chosen, std::move(found))};
  static_cast<void>(reads_standard_input(parsed.options));  // by two at a time is refused
  return parsed;
}

}  // namespace nutik::app
