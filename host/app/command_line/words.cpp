#include "app/command_line/words.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "session/text/text_table.hpp"
#include "system/is_absent.hpp"

namespace nutik::app {
namespace {

namespace fs = std::filesystem;

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

// `clip.tik`, not `29.97` or `0.4s`.
bool looks_like_file(const std::string& value) {
  const std::string extension = fs::path(value).extension().string();
  std::error_code error;
  return extension.size() > 1 && is_letter(extension[1]) && fs::is_regular_file(value, error);
}

// An option of the program, not a negative number.
bool is_option(const std::string& value) {
  if (value.starts_with("--")) return find_option(std::string_view(value).substr(2)) != nullptr;
  return value.size() == 2 && value[0] == '-' && find_option(value[1]) != nullptr;
}

}  // namespace

void check_choice(std::string_view what, const std::string& value, const Option& option) {
  if (option.choice_list.empty() || option.knows(value)) return;
  // A number is another number, not a mistyped one.
  if (std::ranges::count_if(value, is_letter) < 2) return;
  std::vector<std::string> known = option.choices();
  const std::string suggestion = did_you_mean(in_small_letters(value), known);  // no choice has capitals
  if (suggestion.empty()) return;
  for (std::string& choice : known) choice += choice.ends_with(':') ? "…" : "";
  throw UsageError(format("{} {} is not known{} It is one of: {}", what, value, suggestion, joined(known)));
}

namespace {

// Throws UsageError where a value is most likely another word of the command line, or a mistyped one of the
// option's choices: an option's name, a file for a number, a capture for functions. What it lets pass is for
// whoever reads the value to judge. `name` is the option as it was written.
void check_value(const Option& option, const std::string& name, const std::string& value) {
  if (is_option(value)) {
    const std::vector<std::string> choices = option.choices();
    const bool are_all = choices.size() > 1 && !option.takes_file() &&
                         std::ranges::none_of(choices, [](const std::string& each) { return each.ends_with(':'); });
    const std::string needed = are_all ? alternatives(choices) : format("{} {}", name, option.value);
    throw UsageError(
        format("{0} needs a value, {1}, and {2} behind it is an option; write {0}={2} where it is meant as "
               "the value",
               name, needed, value));
  }
  if (option.reads_standard_input() && fs::path(value).extension() == ".tik") {
    throw UsageError(
        format("{0} needs a file of another kind, {0} {1}, and {2} is a capture; is the value of {0} "
               "missing?",
               name, option.value, value));
  }
  if (!option.takes_file() && looks_like_file(value)) {
    throw UsageError(
        format("{0} needs a value, {0} {1}, and {2} behind it is a file; is the value of {0} missing?", name,
               option.value, value));
  }
  if (!option.takes_file() || value.find_first_of("./") == std::string::npos) {
    if (option.takes_file() && !is_absent(value)) return;
    check_choice(name, value, option);
  }
}

// Suggests options of the command that is named; where none is, of those that need not be.
[[noreturn]] void fail_unknown(const std::string& name, std::span<const std::string> words) {
  const auto named =
      std::ranges::find_if(words, [](const std::string& each) { return find_command(each) != nullptr; });
  constexpr std::pair<std::string_view, std::string_view> kOfFfmpeg[]{
      {"-i", "a clip stands without an option"}, {"-ss", "that is --start, of a video --from"},
      {"-r", "that is --fps, of a film --out-fps"},
      {"-t", "that is --exposure"}, {"-to", "that is --to"}, {"-y", "that is --overwrite"}};
  const auto other = std::ranges::find(kOfFfmpeg, std::string_view(name), [](const auto& each) { return each.first; });
  if (other != std::end(kOfFfmpeg)) throw UsageError(format("there is no option {}; {}", name, other->second));
  std::vector<std::string> known{"--help", "--version"};
  std::vector<const Command*> meant;
  if (named != words.end()) {
    meant = {find_command(*named)};
  } else {
    meant = {&command(CommandId::expose), &command(CommandId::encode), &command(CommandId::info)};
  }
  for (const Command* each : meant) {
    for (const Option* option : options_of(each->id)) known.push_back(option->name());
  }
  throw UsageError(format("there is no option {}{}; see nutik-cl {}--help", shown(name),
                          did_you_mean(name, known), named != words.end() ? *named + " " : ""));
}

class Reader {
 public:
  explicit Reader(std::span<const std::string> words) : words_(words) {}

  Words read() {
    while (at_ < words_.size()) {
      const std::string& word = words_[at_++];
      if (word == "--") {
        const auto rest = words_.subspan(at_);
        found_.operands.insert(found_.operands.end(), rest.begin(), rest.end());
        break;
      }
      if (word == "--help" || word == "-h") {
        found_.help = true;
      } else if (constexpr std::string_view kTopic = "--help="; word.starts_with(kTopic)) {
        found_.help = true;
        found_.topic = word.substr(kTopic.size());
      } else if (word == "--version" || word == "-V") {
        found_.version = true;
      } else if (word.starts_with("--")) {
        take_long(word);
      } else if (word.size() > 1 && word[0] == '-') {
        take_short(word);
      } else {
        take_operand(word);
      }
    }
    return std::move(found_);
  }

 private:
  void take_operand(const std::string& word) {
    if (found_.command == nullptr && found_.operands.empty()) {
      if (word == "help") {
        found_.help = found_.is_help_word = true;
        return;
      }
      if (word == "version") {
        found_.version = true;
        return;
      }
      found_.command = find_command(word);
      if (found_.command != nullptr) return;
    }
    found_.operands.push_back(word);
  }

  void take_long(const std::string& word) {
    const auto equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const Option* option = find_option(std::string_view(name).substr(2));
    if (option == nullptr) fail_unknown(name, words_);
    if (equals == std::string::npos) return take(*option, name);
    take(*option, name, word.substr(equals + 1));
    check_choice(name, found_.given.back().words.front(), *option);
  }

  // Flags may stand together, and the last letter may take a value: -qo out.png, -k trail.fn, -f120.
  void take_short(const std::string& word) {
    for (std::size_t letter = 1; letter < word.size(); ++letter) {
      const std::string name{'-', word[letter]};
      const Option* option = find_option(word[letter]);
      // One dash and several letters: a whole word was meant.
      if (option == nullptr) fail_unknown(letter == 1 ? word : name, words_);
      if (!option->is_flag() && letter + 1 < word.size()) return take(*option, name, word.substr(letter + 1));
      take(*option, name);
    }
  }

  // The words of an option, the first of which may have stood in one word with its name.
  void take(const Option& option, const std::string& name, const std::optional<std::string>& first = {}) {
    std::vector<std::string>& words = found_.given.emplace_back(Given{&option, name, {}}).words;
    if (option.is_flag()) {
      if (first) throw UsageError(format("{} takes no value", option.display_name()));
      return;
    }
    if (first) words.push_back(*first);
    while (words.size() < option.word_count()) {
      if (at_ == words_.size()) {
        found_.unfinished = true;
        return;
      }
      words.push_back(words_[at_++]);
    }
    if (!first && option.word_count() == 1) check_value(option, name, words.front());
  }

  std::span<const std::string> words_;
  std::size_t at_ = 0;
  Words found_;
};

}  // namespace

Words Words::of(std::span<const std::string> words) { return Reader(words).read(); }

}  // namespace nutik::app
