#include "session/text/shell_text.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"

namespace nutik {

std::string shell_word(std::string_view word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,=+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) return std::string(word);
  if (printable(word) != word) {
    // Seen before it is run: what a terminal would obey, or not show, stands there in numbers. POSIX has no quotes for
    // that; line ends at the end, which $() drops, are in quotes.
    const std::string_view text = word.substr(0, word.find_last_not_of('\n') + 1);
    std::string escaped;
    for (const char c : text) {
      const bool is_plain = c >= ' ' && c <= '~' &&
                            std::string_view("'\"\\%!$`").find(c) == std::string_view::npos &&
                            (c != '-' || !escaped.empty());
      escaped += is_plain ? std::string(1, c) : format("\\{:03o}", static_cast<unsigned char>(c));
    }
    const std::string line_ends(word.substr(text.size()));
    return "\"$(printf '" + escaped + "')\"" + (line_ends.empty() ? "" : "'" + line_ends + "'");
  }
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string not_an_option(std::string_view name) {
  return (name.starts_with('-') && name != "-" ? "./" : "") + std::string(name);
}

std::vector<std::string> shell_words(std::string_view line) {
  constexpr std::string_view kEscapedInQuotes = "\"\\$`";
  std::vector<std::string> words;
  bool is_in_word = false;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote == 0 && (c == ' ' || c == '\t')) {
      is_in_word = false;
      continue;
    }
    if (!is_in_word) words.emplace_back();
    is_in_word = true;
    const bool escapes = c == '\\' && quote != '\'' && i + 1 < line.size() &&
                         (quote == 0 || kEscapedInQuotes.find(line[i + 1]) != std::string_view::npos);
    if (escapes) {
      words.back() += line[++i];
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (quote != 0 && c == quote) {
      quote = 0;
    } else {
      words.back() += c;
    }
  }
  if (quote != 0) throw UsageError(format("the quote {} is not closed: {}", quote, line));
  return words;
}

}  // namespace nutik
