// Completion for shells, which ask the program itself: a script calls `nutik-cl completion -- SHELL WORD...` and offers
// what that answers.

#include <algorithm>
#include <set>

#include "app/command_line/command_table.hpp"
#include "app/command_line/help.hpp"
#include "app/command_line/words.hpp"
#include "app/output/console.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kAnyFile = ":files\n";

constexpr std::string_view kBash =
    R"sh(# Completion of nutik-cl for bash; written by `nutik-cl completion bash`.

_nutik_cl() {
  local cur=${COMP_WORDS[COMP_CWORD]} IFS=$'\n' line word
  local -a words
  # bash makes --name=value three words.
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
    [ "$word" = = ] || words+=("$word")
  done
  if [ "$cur" = = ]; then
    cur=
    words+=('')
  fi
  COMPREPLY=()
  for line in $("${COMP_WORDS[0]/#\~/$HOME}" completion -- bash "${words[@]}" 2>/dev/null); do
    case $line in
      :files) compopt -o filenames 2>/dev/null
        COMPREPLY+=($(compgen -f -- "$cur")) ;;
      :files*) compopt -o filenames 2>/dev/null
        COMPREPLY+=($(compgen -d -- "$cur"))
        for word in $(compgen -f -- "$cur"); do
          [[ $word == *.@(${line#:files }) ]] && COMPREPLY+=("$word")
        done ;;
      "$cur"*) COMPREPLY+=("${line%%$'\t'*}") ;;
    esac
  done
  [ ${#COMPREPLY[@]} -eq 1 ] && [[ ${COMPREPLY[0]} == *: ]] && compopt -o nospace 2>/dev/null
  return 0
}

complete -F _nutik_cl nutik-cl
)sh";

constexpr std::string_view kZsh = R"sh(#compdef nutik-cl
# Completion of nutik-cl for zsh; written by `nutik-cl completion zsh`.

_nutik-cl() {
  local line
  local -a answer described
  answer=("${(f)$("${${(Q)words[1]}/#\~/$HOME}" completion -- zsh "${(@Q)words[2,CURRENT]}" 2>/dev/null)}")
  compset -P '--*='
  for line in $answer; do
    case $line in
      :files) _files ;;
      :files*) _files -g "*.(${line#:files })(-.)" ;;
      *) described+=("${${line//:/\\:}/$'\t'/:}") ;;
    esac
  done
  (( $#described )) && _describe 'how it goes on' described
}

_nutik-cl "$@"
)sh";

constexpr std::string_view kFish =
    R"sh(# Completion of nutik-cl for fish; written by `nutik-cl completion fish`.

function __nutik_cl
  set -l words (commandline -opc)
  set -l program (string replace -r '^~' $HOME $words[1])
  set -l token (commandline -ct)
  # --name=value is one word.
  set -l name (string match -r -- '^--[^=]*=' $token)
  set -l value (string replace -r -- '^--[^=]*=' '' $token)
  for line in ($program completion -- fish $words[2..-1] "$token" 2>/dev/null)
    switch $line
      case ':files*'
        set -l extensions (string sub -s 8 -- $line)
        for path in (__fish_complete_path "$value")
          if test -z "$extensions"; or string match -qr -- "(/|\.($extensions))(\t.*)?\$" $path
            echo "$name$path"
          end
        end
      case '*'
        echo "$name$line"
    end
  end
end

complete -c nutik-cl -f -a '(__nutik_cl)'
)sh";

std::string described(std::string_view word, std::string_view text) {
  return format("{}\t{}\n", word, brief(text));
}

std::string option_lines(const Command* command) {
  std::string lines = described("--help", "show what it takes");
  if (command == nullptr) lines += described("--version", "show the version");
  std::set<std::string_view> met;  // what several commands call by one name completes alike
  for (const Option& option : schema()) {
    const bool is_taken =
        command != nullptr ? option.is_of(command->id)
                           : std::ranges::any_of(kShorthand, [&](CommandId id) { return option.is_of(id); });
    if (is_taken && option.heading != kSeldomNeeded && met.insert(option.long_name).second)
      lines += described(option.name(), option.help);
  }
  return lines;
}

std::string choice_lines(const Option& option) {
  std::string lines;
  for (const std::string& choice : option.choices()) lines += choice + "\n";
  return lines;
}

std::string value_lines(const Option& option) {
  const std::string lines = choice_lines(option);
  if (!option.takes_file() && !option.value.starts_with("WHERE")) return lines;
  const std::string_view extension = option.file_extension();
  if (extension.empty()) return lines + std::string(kAnyFile);
  // Masks may be of either kind; a picture's name says only one of those that can be written.
  return lines + format(":files {}\n", extension == "pgm" ? "pgm|png" : extension);
}

std::string operand_lines(const Command& command, bool is_first) {
  const std::string_view text = command.operands;
  if (text.empty()) return {};
  if (command.id == CommandId::shutter && is_first) return choice_lines(*find_option("shutter"));
  if (std::ranges::all_of(text, [](char c) { return c == '|' || (c >= 'a' && c <= 'z'); })) {
    std::string lines = std::string(text) + '\n';
    std::ranges::replace(lines, '|', '\n');
    return lines;
  }
  const bool is_capture =
      text.find(".tik") != std::string_view::npos && text.find("CLIP") == std::string_view::npos;
  return is_capture ? ":files tik\n" : std::string(kAnyFile);
}

std::string completion_script(std::string_view shell) {
  if (shell == "bash") return std::string(kBash);
  if (shell == "zsh") return std::string(kZsh);
  if (shell == "fish") return std::string(kFish);
  throw UsageError(format("there is no completion for '{}'; choose bash, zsh or fish", shell));
}

// How a command line may go on whose last word, which may be empty, is being typed. A line for each possibility:
//
//   encode<TAB>Turn a video …     a word, and what it is
//   :files                        any file
//   :files pgm|png                a file that ends so, or a folder
//
// The value alone of --name=VALUE is completed. Empty where nothing is known, or the words before make no sense.
std::string completions(std::span<const std::string> words) {
  try {
    const Words before = Words::of(words.first(words.size() - 1));
    const auto row = [&](const Option& named) {
      const Option* own = before.command != nullptr ? option_of(before.command->id, named.long_name) : nullptr;
      return value_lines(own != nullptr ? *own : named);
    };
    if (before.unfinished) return row(*before.given.back().option);
    const std::string_view typed = words.back();
    const auto equals = typed.find('=');
    if (typed.starts_with("--") && equals != std::string_view::npos) {
      const Option* option = find_option(typed.substr(2, equals - 2));
      return option != nullptr ? row(*option) : std::string();
    }
    if (typed.starts_with('-')) return option_lines(before.command);
    if (before.command != nullptr) return operand_lines(*before.command, before.operands.empty());
    std::string lines;
    for (const Command& command : commands()) lines += described(command.name, command.summary);
    return lines + std::string(kAnyFile);
  } catch (const UsageError&) {
    return {};
  }
}

}  // namespace

int run_completion(const Options& options) {
  if (options.operands.empty()) throw UsageError("for which shell? nutik-cl completion bash, zsh or fish");
  const std::string script = completion_script(options.operands.front());
  const std::span<const std::string> words = std::span(options.operands).subspan(1);
  print_text(words.empty() ? script : completions(words));
  return 0;
}

}  // namespace nutik::app
