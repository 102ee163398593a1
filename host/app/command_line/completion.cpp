#include "app/command_line/completion.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "app/command_line/help_text.hpp"
#include "app/command_line/option_table.hpp"
#include "session/error.hpp"
#include "session/format.hpp"

namespace nutik::app {
namespace {

std::string joined(const std::vector<std::string>& words, std::string_view between = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : std::string(between)) + word;
  return text;
}

std::vector<std::string> names_of(const Option& option) {
  std::vector<std::string> names;
  if (option.short_name != 0) names.push_back({'-', option.short_name});
  names.push_back(option.name());
  return names;
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Command& command : commands()) names.emplace_back(command.name);
  return names;
}

std::vector<std::string> choices_of(const Option& option) {
  return {option.choices.begin(), option.choices.end()};
}

// A row for each name: what several commands call by one name completes alike.
std::vector<const Option*> distinct_options() {
  std::vector<const Option*> distinct;
  std::set<std::string_view> met;
  for (const Option& option : options()) {
    if (met.insert(option.long_name).second) distinct.push_back(&option);
  }
  return distinct;
}

// Those of a command, or without one of the paper's forms, in the order of the table.
std::vector<const Option*> options_without_command() {
  std::vector<const Option*> found;
  for (const Option* option : distinct_options()) {
    if (std::ranges::any_of(kShorthand, [&](CommandId id) { return option->is_of(id); })) {
      found.push_back(option);
    }
  }
  return found;
}

// What the first operand of a command can be.
struct OperandKind {
  std::vector<std::string> words;       // these
  std::vector<std::string> extensions;  // else files with these; none: any
  bool is_nothing = false;
};

OperandKind operands_of(const Command& command) {
  OperandKind kind;
  const std::string_view text = command.operands;
  if (text.empty()) {
    kind.is_nothing = true;
  } else if (command.id == CommandId::shutter) {
    kind.words = choices_of(*find_option("shutter"));
  } else if (std::ranges::all_of(text, [](char c) { return c == '|' || (c >= 'a' && c <= 'z'); })) {
    for (std::size_t start = 0; start <= text.size(); start = text.find('|', start) + 1) {
      kind.words.emplace_back(text.substr(start, text.find('|', start) - start));
      if (text.find('|', start) == std::string_view::npos) break;
    }
  } else if (text.find(".tik") != std::string_view::npos && text.find("CLIP") == std::string_view::npos) {
    kind.extensions = {"tik"};
  }
  return kind;
}

// Masks may be of either kind; a picture's name says only one of those that can be written.
std::vector<std::string> extensions_of(const Option& option) {
  const std::string_view extension = option.file_extension();
  if (extension.empty()) return {};
  if (extension == "pgm") return {"pgm", "png"};
  return {std::string(extension)};
}

// --- bash

std::string bash_script() {
  std::string text = R"(# Completion of nutik-cl for bash; written by `nutik-cl completion bash`.

# Files that end with one of these extensions, or any, and folders.
_nutik_cl_files() {
  local IFS=$'\n' extension
  compopt -o filenames 2>/dev/null
  if [ $# -eq 0 ]; then
    COMPREPLY=($(compgen -f -- "$cur"))
    return
  fi
  COMPREPLY=($(compgen -d -- "$cur"))
  for extension; do
    COMPREPLY+=($(compgen -f -X "!*.$extension" -- "$cur"))
  done
}

_nutik_cl_words() {
  COMPREPLY=($(compgen -W "$1" -- "$cur"))
  [ ${#COMPREPLY[@]} -eq 1 ] && [[ ${COMPREPLY[0]} == *: ]] && compopt -o nospace 2>/dev/null
  return 0
}

_nutik_cl() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command= i
  COMPREPLY=()
  # bash makes --name=value three words.
  if [ "$cur" = = ]; then
    cur=
  elif [ "$prev" = = ]; then
    prev=${COMP_WORDS[COMP_CWORD-2]}
  fi
)";
  const std::string names = joined(command_names());
  text += format(R"(  for ((i = 1; i < COMP_CWORD; ++i)); do
    case " {} " in
      *" ${{COMP_WORDS[i]}} "*) command=${{COMP_WORDS[i]}}; break ;;
    esac
  done

  case $prev in
)",
                 names);
  std::vector<std::string> free;
  for (const Option* option : distinct_options()) {
    if (option->is_flag()) continue;
    const std::string pattern = joined(names_of(*option), "|");
    if (option->takes_file()) {
      text += format("    {}) _nutik_cl_files {}; return ;;\n", pattern, joined(extensions_of(*option)));
    } else if (!option->choices.empty()) {
      text += format("    {}) _nutik_cl_words '{}'; return ;;\n", pattern, joined(choices_of(*option)));
    } else {
      free.push_back(pattern);
    }
  }
  text += format("    {}) return ;;\n  esac\n\n", joined(free, "|"));
  text += "  if [[ $cur == -* ]]; then\n    case $command in\n";
  const auto add_options = [&](std::string_view command, const std::vector<const Option*>& options) {
    std::vector<std::string> words{"--help"};
    if (command.empty()) words.emplace_back("--version");
    for (const Option* option : options) words.push_back(option->name());
    text += format("      {}) _nutik_cl_words '{}' ;;\n", command.empty() ? "''" : command, joined(words));
  };
  add_options("", options_without_command());
  for (const Command& command : commands()) add_options(command.name, options_of(command));
  text += format(
      "    esac\n    return\n  fi\n\n  case $command in\n    '')\n      _nutik_cl_files\n"
      "      COMPREPLY+=($(compgen -W '{}' -- \"$cur\"))\n      ;;\n",
      names);
  for (const Command& command : commands()) {
    const OperandKind kind = operands_of(command);
    if (kind.is_nothing) {
      text += format("    {}) ;;\n", command.name);
    } else if (!kind.words.empty()) {
      text += format("    {}) _nutik_cl_words '{}' ;;\n", command.name, joined(kind.words));
    } else if (!kind.extensions.empty()) {
      text += format("    {}) _nutik_cl_files {} ;;\n", command.name, joined(kind.extensions));
    }
  }
  return text + "    *) _nutik_cl_files ;;\n  esac\n}\n\ncomplete -F _nutik_cl nutik-cl\n";
}

// --- zsh

// Inside the brackets or between the colons of _arguments, in single quotes.
std::string zsh_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result;
}

std::string zsh_files(const std::vector<std::string>& extensions) {
  if (extensions.empty()) return "_files";
  return format("_files -g \"*.({})(-.)\"", joined(extensions, "|"));
}

// `:NAME:what completes it` for each word of an option's value.
std::string zsh_values(const Option& option) {
  std::string text;
  for (std::size_t start = 0; start < option.value.size();) {
    const auto end = std::min(option.value.find(' ', start), option.value.size());
    text += format(":{}:", zsh_text(option.value.substr(start, end - start)));
    if (option.takes_file()) {
      text += zsh_files(extensions_of(option));
    } else if (!option.choices.empty()) {
      text += format("({})", zsh_text(joined(choices_of(option))));
    } else {
      text += ' ';
    }
    start = end + 1;
  }
  return text;
}

std::string zsh_option(const Option& option) {
  const std::vector<std::string> names = names_of(option);
  const std::string rest = format("[{}]{}", zsh_text(brief(option.help)), zsh_values(option));
  const std::string repeat = option.is_repeatable() ? "*" : "";
  if (names.size() == 1) return format("'{}{}{}'", repeat, names.front(), rest);
  return format("'({0} {1})'{{{0},{1}}}'{2}'", names[0], names[1], rest);
}

std::string zsh_script() {
  std::string text =
      "#compdef nutik-cl\n"
      "# Completion of nutik-cl for zsh; written by `nutik-cl completion zsh`.\n\n"
      "_nutik-cl() {\n  local command= word\n  local -a commands\n  commands=(\n";
  for (const Command& command : commands()) {
    text += format("    '{}:{}'\n", command.name, zsh_text(brief(command.summary)));
  }
  text +=
      "  )\n"
      "  for word in ${words[2,CURRENT-1]}; do\n"
      "    if (( ${commands[(I)${(b)word}:*]} )); then\n      command=$word\n      break\n    fi\n  done\n"
      "  case $command in\n";
  const auto add = [&](std::string_view pattern, const std::vector<const Option*>& options,
                       const std::string& operands) {
    text += format("    {})\n      _arguments -s -S '--help[show what it takes]'", pattern);
    for (const Option* option : options) text += " \\\n        " + zsh_option(*option);
    if (!operands.empty()) text += format(" \\\n        '*:file:{}'", operands);
    text += "\n      ;;\n";
  };
  add("''", options_without_command(), "{_describe command commands; _files}");
  for (const Command& command : commands()) {
    const OperandKind kind = operands_of(command);
    add(command.name, options_of(command),
        kind.is_nothing       ? ""
        : !kind.words.empty() ? format("({})", zsh_text(joined(kind.words)))
                              : zsh_files(kind.extensions));
  }
  return text + "  esac\n}\n\n_nutik-cl \"$@\"\n";
}

// --- fish

std::string fish_word(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return result + "'";
}

std::string fish_files(const std::vector<std::string>& extensions) {
  std::string text;
  for (const std::string& extension : extensions) {
    text += format("{}(__fish_complete_suffix .{})", text.empty() ? "" : " ", extension);
  }
  return text;
}

std::string fish_script() {
  std::string text =
      "# Completion of nutik-cl for fish; written by `nutik-cl completion fish`.\n\n"
      "function __nutik_cl_command\n  for word in (commandline -opc)[2..-1]\n"
      "    if contains -- $word " +
      joined(command_names()) +
      "\n      echo $word\n      return\n    end\n  end\n  echo none\nend\n\n"
      "function __nutik_cl_is\n  contains -- (__nutik_cl_command) $argv\nend\n\n";
  for (const Command& command : commands()) {
    text += format("complete -c nutik-cl -n '__nutik_cl_is none' -a {} -d {}\n", command.name,
                   fish_word(brief(command.summary)));
  }
  text +=
      "complete -c nutik-cl -l help -s h -d 'show what it takes'\n"
      "complete -c nutik-cl -n '__nutik_cl_is none' -l version -d 'show the version'\n";
  for (const Option& option : options()) {
    std::vector<std::string> takers;
    bool is_shorthand = false;
    for (const Command& command : commands()) {
      if (!option.is_of(command.id)) continue;
      takers.emplace_back(command.name);
      is_shorthand = is_shorthand || std::ranges::find(kShorthand, command.id) != std::end(kShorthand);
    }
    if (is_shorthand) takers.emplace_back("none");
    text += format("complete -c nutik-cl -n '__nutik_cl_is {}'", joined(takers));
    if (option.short_name != 0) text += format(" -s {}", option.short_name);
    text += format(" -l {}", option.long_name);
    if (!option.choices.empty()) {
      text +=
          format(" {} -a {}", option.takes_file() ? "-r -F" : "-x", fish_word(joined(choices_of(option))));
    } else if (const auto extensions = extensions_of(option); !extensions.empty()) {
      text += format(" -x -a {}", fish_word(fish_files(extensions)));
    } else if (option.takes_file()) {
      text += " -r -F";
    } else if (!option.is_flag()) {
      text += " -x";
    }
    text += format(" -d {}\n", fish_word(brief(option.help)));
  }
  for (const Command& command : commands()) {
    const OperandKind kind = operands_of(command);
    const std::string words = !kind.words.empty() ? joined(kind.words) : fish_files(kind.extensions);
    if (!kind.is_nothing && words.empty()) continue;
    text += format("complete -c nutik-cl -n '__nutik_cl_is {}' -f", command.name);
    text += words.empty() ? "\n" : format(" -a {}\n", fish_word(words));
  }
  return text;
}

}  // namespace

std::string completion_script(std::string_view shell) {
  if (shell == "bash") return bash_script();
  if (shell == "zsh") return zsh_script();
  if (shell == "fish") return fish_script();
  throw UsageError(format("there is no completion for '{}'; choose bash, zsh or fish", shell));
}

}  // namespace nutik::app
