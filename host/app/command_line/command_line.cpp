#include "app/command_line/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "app/command_line/help.hpp"
#include "app/command_line/suggestion.hpp"
#include "app/command_line/value_check.hpp"
#include "app/input/standard_input.hpp"
#include "app/output/console.hpp"
#include "app/text/shell_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

// What the first pass over the words learns: which of them are operands, and which options occur.
struct Scan {
  std::vector<std::size_t> operands;  // positions in the words
  std::vector<const Option*> options;
  std::size_t operands_end = 0;  // position of `--`, or the number of words
  bool help = false;
  bool version = false;

  [[nodiscard]] bool has(std::string_view long_name) const {
    return std::any_of(options.begin(), options.end(),
                       [&](const Option* option) { return option->long_name == long_name; });
  }
};

// Suggests options of the command that is named, if any, before those of others.
[[noreturn]] void fail_unknown_option(const std::string& word, std::span<const std::string> words) {
  const std::string name = word.substr(0, word.find('='));
  const auto named =
      std::ranges::find_if(words, [](const std::string& each) { return find_command(each) != nullptr; });
  std::vector<std::string> known{"--help", "--version"};
  if (named != words.end()) {
    for (const Option* option : options_of(*find_command(*named)))
      known.push_back("--" + std::string(option->long_name));
    if (const std::string suggestion = did_you_mean(name, known); !suggestion.empty()) {
      throw UsageError(format("there is no option {}{}; see nutik-cl {} --help", name, suggestion, *named));
    }
  }
  for (const Option& option : options()) known.push_back("--" + std::string(option.long_name));
  throw UsageError(format("there is no option {}{}; see nutik-cl --help", name, did_you_mean(name, known)));
}

Scan scan(std::span<const std::string> words) {
  Scan scan;
  scan.operands_end = words.size();
  const auto take = [&](const Option* option, const std::string& word, bool has_value, std::size_t& i) {
    if (option == nullptr) fail_unknown_option(word, words);
    scan.options.push_back(option);
    if (option->value.empty()) {
      if (has_value) throw UsageError(format("{} takes no value", option->display_name()));
      return;
    }
    i += option->word_count() - (has_value ? 1 : 0);
    if (i >= words.size()) {
      const std::string name = word.substr(0, word.find('='));
      throw UsageError(format("{} needs {}: {} {}", name,
                              option->word_count() == 1 ? "a value" : "more words", name, option->value));
    }
    if (has_value && word.find('=') != std::string::npos) {
      check_choice(word.substr(0, word.find('=')), word.substr(word.find('=') + 1), option->choices);
    }
    if (!has_value && option->word_count() == 1) check_value(*option, word, words[i]);
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--") {
      scan.operands_end = i;
      for (std::size_t j = i + 1; j < words.size(); ++j) scan.operands.push_back(j);
      break;
    }
    if (word == "--help" || word == "-h") {
      scan.help = true;
    } else if (word == "--version") {
      scan.version = true;
    } else if (word.starts_with("--")) {
      const auto equals = word.find('=');
      take(find_option(std::string_view(word).substr(2, equals == std::string::npos ? equals : equals - 2)),
           word, equals != std::string::npos, i);
    } else if (word.size() > 1 && word[0] == '-') {
      const Option* option = find_option(word[1]);
      const bool is_flag = option != nullptr && option->value.empty();
      take(option, word.substr(0, 2), !is_flag && word.size() > 2, i);
      // Flags may stand together, the last letter may take a value: -qo out.png
      std::size_t letter = 1;
      while (is_flag && ++letter < word.size()) {
        const Option* next = find_option(word[letter]);
        take(next, std::string{'-', word[letter]}, next && !next->value.empty() && letter + 1 < word.size(),
             i);
        if (next->value.empty()) continue;
        break;
      }
    } else {
      scan.operands.push_back(i);
    }
  }
  return scan;
}

bool ends_with_tik(const std::string& word) {
  return word.size() >= 4 && word.compare(word.size() - 4, 4, ".tik") == 0;
}

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

// The paper's forms: no command, only what belongs to it.
const Command& shorthand(const Scan& scan, std::span<const std::string> words) {
  const bool exposes = scan.has("functions") || scan.has("start") || scan.has("exposure") ||
                       scan.has("every") || scan.has("count") || scan.has("shutter");
  if (exposes) return command(CommandId::expose);
  const std::string first = scan.operands.empty() ? std::string() : words[scan.operands.front()];
  const std::string clip = first.empty() ? "clip.tik" : first;
  if (scan.has("mask")) {
    throw UsageError(
        format("a mask needs gain functions: nutik-cl -m mask.pgm -k functions.fn {}", shell_word(clip)));
  }
  if (scan.operands.empty()) {
    throw UsageError("a clip or a capture is missing: nutik-cl clip.mp4 clip.tik");
  }
  fail_misspelt_command(first);
  if (scan.operands.size() == 1 && !scan.has("output")) {
    if (ends_with_tik(first) && scan.options.size() == scan.has("quiet")) return command(CommandId::info);
    if (ends_with_tik(first)) {
      throw UsageError(
          format("what should be done with {}? To expose a picture: nutik-cl --start 0s "
                 "--exposure 10ms {} picture.png",
                 first, shell_word(first)));
    }
    const std::string stem = std::filesystem::path(first).stem().string();
    throw UsageError(
        format("the output is missing: nutik-cl {} {}", shell_word(first), shell_word(stem + ".tik")));
  }
  return command(CommandId::encode);
}

void check_options(const Scan& scan, const Command& command) {
  for (auto said = scan.options.begin(); said != scan.options.end(); ++said) {
    const Option* option = option_of(command, (*said)->long_name);
    if (option == nullptr) {
      std::string takers;
      for (const Command& other : commands()) {
        if (option_of(other, (*said)->long_name) == nullptr) continue;
        takers += format("{}{}", takers.empty() ? "" : ", ", other.name);
      }
      throw UsageError(format("{} does not go with {}; it is an option of: {}", (*said)->display_name(),
                              command.name, takers));
    }
    if (!option->value.empty() && !option->is_repeatable &&
        std::find(scan.options.begin(), said, *said) != said) {
      throw UsageError(format("{} is given twice", option->display_name()));
    }
  }
}

// CLI11 does the parsing itself, from the table's entries for one command.
Options parse_options(const Command& command, std::vector<std::string> words) {
  Options parsed;
  CLI::App app;
  app.set_help_flag();
  for (const Option& option : options()) {
    if ((option.commands & bit(command.id)) == 0) continue;
    const std::string names = (option.short_name != 0 ? std::string{'-', option.short_name} + "," : "") +
                              "--" + std::string(option.long_name);
    // Each time it is met, so that Options::said has the order of the command line.
    const auto take = [&parsed, &option](const std::vector<std::string>& values) {
      parsed.said.push_back({option.long_name, values});
      if (option.set) option.set(parsed, values.empty() ? std::string() : values.front());
    };
    if (option.value.empty()) {
      app.add_flag_callback(names, [take] { take({}); })->trigger_on_parse();
    } else {
      app.add_option_function<std::vector<std::string>>(names, take)
          ->type_size(static_cast<int>(option.word_count()))
          ->expected(1)
          ->allow_extra_args(false)
          ->trigger_on_parse();
    }
  }
  app.add_option("operands", parsed.operands);
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the back
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw UsageError(format("{}; see nutik-cl {} --help", error.what(), command.name));
  }
  return parsed;
}

}  // namespace

ParsedCommandLine parse_command_line(std::span<const std::string> words) {
  const Scan found = scan(words);
  if (found.version) {
    print_version();
    return {};
  }
  // The command's name, if any, stands before all operands and before `--`.
  const Command* named = nullptr;
  std::vector<std::string> rest(words.begin(), words.end());
  if (!found.operands.empty() && found.operands.front() < found.operands_end) {
    named = find_command(words[found.operands.front()]);
    if (named != nullptr) rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(found.operands.front()));
  }
  if (found.help) {
    named != nullptr ? print_command_help(*named) : print_help();
    return {};
  }
  if (words.empty()) {
    throw UsageError("say what to do: nutik-cl clip.mp4 clip.tik encodes a clip; nutik-cl --help says more");
  }
  const Command& chosen = named != nullptr ? *named : shorthand(found, words);
  check_options(found, chosen);
  ParsedCommandLine parsed{&chosen, parse_options(chosen, std::move(rest))};
  check_standard_input(parsed.options);
  return parsed;
}

}  // namespace nutik::app
