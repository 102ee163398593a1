#include "app/command_line/help.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "app/output/console.hpp"
#include "capture/format.hpp"
#include "session/text/text_table.hpp"

namespace nutik::app {
namespace {

constexpr std::size_t kNarrowest = 60;
constexpr std::size_t kDefault = 80;
constexpr std::size_t kWidest = 100;  // longer lines are hard to read
constexpr std::size_t kOptionColumn = 32;
constexpr std::size_t kCommandColumn = 14;

// Of the terminal, or as COLUMNS says.
std::size_t line_width() {
  std::size_t width = kDefault;
  winsize size{};
  if (isatty(STDOUT_FILENO) == 1 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    width = size.ws_col;
  }
  if (const char* stated = std::getenv("COLUMNS")) {
    const std::string_view text(stated);
    std::from_chars(text.data(), text.data() + text.size(), width);
  }
  return std::clamp(width, kNarrowest, kWidest);
}

// Words between blanks; what a shell takes for one word because it is quoted is one.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (std::string& part : parts_of(text, ' ')) {
    const bool is_open = !words.empty() && std::ranges::count(words.back(), '\'') % 2 == 1;
    is_open ? void(words.back() += " " + part) : words.push_back(std::move(part));
  }
  return words;
}

// `text` in lines that fit, all but the first after `indent` blanks. A line that goes on ends with `at_break`.
std::string wrapped(std::string_view text, std::size_t indent, std::string_view at_break = {}) {
  static const std::size_t width = line_width();
  std::string result;
  std::size_t column = indent;
  for (const std::string& word : at_break.empty() ? parts_of(text, ' ') : words_of(text)) {
    if (column > indent && column + 1 + columns(word) + at_break.size() > width) {
      result += format("{}\n{:{}}", at_break, "", indent);
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += columns(word);
  }
  return result;
}

std::string option_lines(const Option& option) {
  const std::string short_name = option.short_name != 0 ? format("-{}, ", option.short_name) : "    ";
  std::string names =
      format("  {}{}{}{}", short_name, option.name(), option.is_flag() ? "" : " ", option.value);
  const bool fits = names.size() + 2 <= kOptionColumn;
  names += fits ? std::string(kOptionColumn - names.size(), ' ') : '\n' + std::string(kOptionColumn, ' ');
  return names + wrapped(option.help, kOptionColumn) + '\n';
}

}  // namespace

std::string brief(std::string_view summary) {
  for (const std::string_view end : {". ", " (default", ": "}) summary = summary.substr(0, summary.find(end));
  return std::string(summary) + (summary.ends_with('.') ? "" : ".");
}

void print_version() { print_line("nutik-cl " NUTIK_VERSION); }

void print_help() {
  std::string text = wrapped(kWhatItIs, 0) +
                     "\n\n"
                     "  nutik-cl study clip.mp4                                    a motion study\n"
                     "  nutik-cl clip.mp4 clip.tik                                 encode a clip\n"
                     "  nutik-cl --start 0.4s --exposure 10ms clip.tik moment.png  expose an interval\n"
                     "  nutik-cl -m mask.pgm -k functions.fn clip.tik out.png      expose by functions\n"
                     "  nutik-cl clip.tik                                          say what it holds\n"
                     "\n" +
                     format("{}\n  {}\n", wrapped(kAboutFunctionFiles, 0), kFunctionFile);
  for (const std::string_view group : kCommandGroups) {
    text += format("\n{}:\n", group);
    for (const Command* command : commands_of(group)) {
      text += format("  {:<{}}{}\n", command->name, kCommandColumn - 2,
                     wrapped(brief(command->summary), kCommandColumn));
    }
  }
  text += "\n" +
          wrapped(
              "nutik-cl COMMAND --help says more. A file that is named like a command is written ./info, or "
              "after --.",
              0);
  print_line(text);
}

void print_command_help(const Command& command) {
  std::string text =
      format("nutik-cl {} [OPTIONS]{}{}\n\n{}\n", command.name, command.operands.empty() ? "" : " ",
             command.operands, wrapped(command.summary, 0));
  std::string_view heading;
  for (const Option* option : options_of(command.id)) {
    if (option->heading != heading) text += format("\n{}:\n", heading = option->heading);
    text += option_lines(*option);
  }
  text += "\nExamples:";
  // As a shell takes them, also where a line goes on.
  for (const std::string& example : parts_of(command.examples, '\n')) {
    text += format("\n  {}", wrapped(example, 6, " \\"));
  }
  print_line(text);
}

}  // namespace nutik::app
