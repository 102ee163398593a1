#include "app/command_line/command_line.hpp"

#include <algorithm>
#include <filesystem>

#include "app/command_line/help.hpp"
#include "app/command_line/words.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/formats/file_kinds.hpp"
#include "session/text/shell_text.hpp"
#include "session/text/text_table.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"

namespace nutik::app {
namespace {

// A first word that names no file and looks like no file's name was meant as a command.
void fail_misspelt_command(const std::string& word) {
  const bool is_word = word.find_first_of("./*?%[") == std::string::npos && word != "-";
  if (!is_word || !is_absent(word)) return;
  std::vector<std::string> known;
  for (const Command& command : commands()) known.push_back(std::string(command.name));
  throw UsageError(
      format("there is no file and no command '{}'{}; see nutik-cl --help", word, did_you_mean(word, known)));
}

// Whether an option says what is exposed, which encoding has no use for.
bool implies_exposure(const Given& given) {
  const Option* option = option_of(CommandId::expose, given.option->long_name);
  return option != nullptr && !option->is_of(CommandId::encode) &&
         (option->scope == Scope::exposure || option->scope == Scope::series);
}

// The paper's forms: no command, only what belongs to it.
const Command& shorthand(const Words& words) {
  if (std::ranges::any_of(words.given, implies_exposure)) return command(CommandId::expose);
  if (words.operands.empty()) throw UsageError("a clip or a capture is missing: nutik-cl clip.mp4 clip.tik");
  const std::string& first = words.operands.front();
  fail_misspelt_command(first);
  for (const std::string& later : std::span(words.operands).subspan(1)) {
    if (find_command(later) != nullptr && is_absent(later))
      throw UsageError(format("the command comes first: nutik-cl {} {}", later, shell_word(first)));
  }
  const auto is_given = [&](std::string_view name) {
    return std::ranges::any_of(words.given,
                               [&](const Given& given) { return given.option->long_name == name; });
  };
  if (words.operands.size() > 1 || is_given("output")) return command(CommandId::encode);
  if (!first.ends_with(".tik")) {
    if (!is_absent(first)) refuse_project(first);
    const std::string stem = first == "-" ? "clip" : std::filesystem::path(first).stem().string();
    throw UsageError(
        format("the output is missing: nutik-cl {} {}", shell_word(first), shell_word(stem + ".tik")));
  }
  const auto is_of_info = [](const Given& given) { return given.option->is_of(CommandId::info); };
  if (std::ranges::all_of(words.given, is_of_info)) return command(CommandId::info);
  throw UsageError(
      format("what should be done with {}? To expose a picture: nutik-cl --start 0s "
             "--exposure 10ms {} picture.png",
             first, shell_word(first)));
}

// `is_named`: the command was, and is not what a line without one means.
[[noreturn]] void fail_other_command(const Option& option, const Command& command, bool is_named) {
  std::vector<std::string> takers, known;
  for (const Command& other : commands()) {
    if (option_of(other.id, option.long_name) != nullptr) takers.emplace_back(other.name);
  }
  if (!is_named && takers.size() == 1)
    throw UsageError(format("{0} is an option of {1}: nutik-cl {1} {0} …", option.display_name(), takers.front()));
  // What says there what this says elsewhere.
  const bool is_length = option.long_name == "exposure" && option_of(command.id, "out-angle") != nullptr;
  const bool is_interval = option.long_name == "start" || option.long_name == "exposure";
  const bool has_part = is_interval && option_of(command.id, "from") != nullptr;
  for (const Option* each : options_of(command.id)) known.push_back(each->name());
  const std::string meant = is_length  ? "; --out-angle says how long each frame is exposed."
                            : has_part ? "; --from and --to say which part."
                                       : did_you_mean(option.name(), known);
  throw UsageError(format("{0} does not go with {1}{2} an option of: {3}", option.display_name(), command.name,
                          meant.empty() ? "; it is" : format("{} {} is", meant, option.display_name()),
                          joined(takers)));
}

Options options_for(const Command& command, Words words, bool is_named) {
  Options options;
  options.operands = std::move(words.operands);
  for (Given& given : words.given) {
    const Option* option = option_of(command.id, given.option->long_name);
    if (option == nullptr) fail_other_command(*given.option, command, is_named);
    option->state(options, option->name(), std::move(given.words));
  }
  return options;
}

}  // namespace

ParsedCommandLine parse_command_line(std::span<const std::string> words) {
  // What follows would look like a line of the program's own.
  for (const std::string& word : words) {
    if (word.find('\n') == std::string::npos) continue;
    throw UsageError(shell_word(word) + " holds a line break: rename the file, or link to it by another name");
  }
  Words found = Words::of(words);
  if (found.version) {
    print_version();
    return {};
  }
  found.help |= found.command != nullptr && found.operands == std::vector<std::string>{"help"} && is_absent("help");
  if (found.help) {
    const auto& rest = found.operands;
    if (found.command == nullptr && found.is_help_word && !rest.empty()) {
      fail_misspelt_command(rest.front());
      throw UsageError(format("there is no command {}; see nutik-cl --help", shell_word(rest.front())));
    }
    if (found.command == nullptr && !found.topic.empty())
      throw UsageError(format("--help={0} is help on a command: nutik-cl COMMAND --help={0}", found.topic));
    const bool is_topic = rest.size() == 1 && (found.is_help_word || is_help_topic(rest.front()));
    if (found.topic.empty() && is_topic) found.topic = rest.front();
    found.command != nullptr ? print_command_help(*found.command, found.topic) : print_help();
    return {};
  }
  if (found.unfinished) {
    const Given& last = found.given.back();
    throw UsageError(format("{0} needs {1}: {0} {2}", last.name,
                            last.option->word_count() == 1 ? "a value" : "more words", last.option->value));
  }
  if (words.empty()) {
    throw UsageError("say what to do: nutik-cl clip.mp4 clip.tik encodes a clip; nutik-cl --help says more");
  }
  const Command& chosen = found.command != nullptr ? *found.command : shorthand(found);
  const bool is_named = found.command != nullptr;
  ParsedCommandLine parsed{&chosen, options_for(chosen, std::move(found), is_named)};
  static_cast<void>(reads_standard_input(parsed.options));  // by two at a time is refused
  return parsed;
}

bool reads_standard_input(const Options& options) {
  const Option* first = nullptr;
  for (const Option& option : schema()) {
    const std::string* name = option.reads_standard_input() ? option.stated(options) : nullptr;
    if (name == nullptr || !is_standard_input(*name)) continue;
    if (first != nullptr) {
      throw UsageError(format("{} - and {} - would both read standard input; name a file for one",
                              first->display_name(), option.display_name()));
    }
    first = &option;
  }
  const bool is_clip = !options.operands.empty() && is_standard_input(options.operands.front());
  if (is_clip && first != nullptr) {
    throw UsageError(format("the clip - and {} - would both read standard input; name a file for one",
                            first->display_name()));
  }
  return is_clip || first != nullptr;
}

}  // namespace nutik::app
