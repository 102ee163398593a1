#include "app/requests/requests.hpp"
#include "features/schema/option.hpp"
#include "session/text/shell_text.hpp"

namespace nutik::app {

std::string stated_words(const Options& options, CommandId command) {
  std::string words;
  for (const Option& option : schema()) {
    const bool counts = option.makes_picture() || option.scope == Scope::computing;
    if (!counts || !option.is_of(command) || !option.is_in(options)) continue;
    words += " " + option.name();
    if (const std::string* const value = option.stated(options)) words += " " + shell_word(*value);
  }
  return words;
}

}  // namespace nutik::app
