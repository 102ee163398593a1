#include "app/command_line/value_check.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

#include "session/text/suggestion.hpp"
#include "session/text/text_table.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
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
  const std::string suggestion = did_you_mean(lower_case(value), known);  // no choice has capitals
  if (suggestion.empty()) return;
  for (std::string& choice : known) choice += choice.ends_with(':') ? "…" : "";
  throw UsageError(format("{} {} is not known{} It is one of: {}", what, value, suggestion, joined(known)));
}

void check_value(const Option& option, const std::string& name, const std::string& value) {
  if (is_option(value)) {
    throw UsageError(
        format("{0} needs a value, {0} {1}, and {2} behind it is an option; write {0}={2} where it "
               "is meant as the value",
               name, option.value, value));
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

}  // namespace nutik::app
