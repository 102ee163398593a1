#include "app/command_line/help.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/output/console.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "session/text/text_table.hpp"

namespace nutik::app {
namespace {

constexpr std::size_t kNarrowest = 60;
constexpr std::size_t kDefault = 80;
constexpr std::size_t kWidest = 100;  // longer lines are hard to read
constexpr std::size_t kOptionColumn = 32;
constexpr std::size_t kCommandColumn = 14;

// The terminal's, or what COLUMNS says.
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

std::string names_of(const Option& option) {
  const std::string short_name = option.short_name != 0 ? format("-{}, ", option.short_name) : "    ";
  return format("  {}{}{}{}", short_name, option.name(), option.is_flag() ? "" : " ", option.value);
}

// All that is said of an option.
std::string option_lines(const Option& option) {
  std::string names = names_of(option);
  const bool fits = names.size() + 2 <= kOptionColumn;
  names += fits ? std::string(kOptionColumn - names.size(), ' ') : '\n' + std::string(kOptionColumn, ' ');
  return names + wrapped(option.help, kOptionColumn) + '\n';
}

// Which options `--help=TOPIC` shows, by their headings.
struct Topic {
  std::string_view name;
  std::vector<std::string_view> headings;
};
const std::vector<Topic>& topics() {
  static const std::vector<Topic> all{{"source", {kSourceClip, kClipCodes, kEventRecording, kMovingCamera}},
                                      {"computing", {kComputing}},
                                      {"output", {kOutputs}}};
  return all;
}

bool is_under(const Option& option, std::span<const std::string_view> headings) {
  return std::ranges::find(headings, option.heading) != headings.end();
}

// A command's options of a topic, or `all`. Throws UsageError for another.
std::vector<const Option*> options_of_topic(const Command& command, std::string_view name) {
  std::vector<const Option*> found = options_of(command.id);
  if (name == "all") return found;
  const auto topic = std::ranges::find(topics(), name, &Topic::name);
  if (topic == topics().end()) {
    throw UsageError(format("there is no help on '{}'; choose all, source, computing or output", printable(name)));
  }
  std::erase_if(found, [&](const Option* option) { return !is_under(*option, topic->headings); });
  return found;
}

// What sets a command apart; all that it takes, where that is little.
std::vector<const Option*> options_of_its_own(const Command& command) {
  constexpr std::size_t kLittle = 11;
  std::vector<const Option*> found = options_of(command.id);
  std::erase_if(found, [](const Option* option) { return option->heading == kSeldomNeeded; });
  if (found.size() <= kLittle) return found;
  std::vector<std::string_view> shared{kClipCodes, kEventRecording, kComputing, kOutputs};
  const bool is_of_source = command.id == CommandId::encode || command.id == CommandId::noise;
  if (!is_of_source) shared.insert(shared.end(), {kSourceClip, kMovingCamera});
  std::erase_if(found, [&](const Option* option) { return is_under(*option, shared); });
  return found;
}

std::string usage(const Command& command) {
  return format("nutik-cl {} [OPTIONS]{}{}\n\n{}\n", command.name, command.operands.empty() ? "" : " ",
                command.operands, wrapped(command.summary, 0));
}

// As a shell takes it, also where it goes on in another line.
std::string example_lines(const std::string& example) { return format("  {}\n", wrapped(example, 6, " \\")); }

// The first three that take one line; else the first.
std::string short_examples(const Command& command) {
  const std::vector<std::string> all = parts_of(command.examples, '\n');
  std::string text;
  for (std::size_t i = 0, left = 3; i < all.size() && left > 0; ++i) {
    if (columns(all[i]) + 2 > kDefault) continue;
    text += example_lines(all[i]);
    --left;
  }
  return text.empty() ? example_lines(all.front()) : text;
}

// In a few words, with the values that it knows if they fit.
std::string short_lines(const Option& option) {
  std::string line = names_of(option) + "  ";
  if (line.size() < kOptionColumn) line.resize(kOptionColumn, ' ');
  line += brief(option.help);
  std::vector<std::string> choices = option.choices();
  if (choices.empty()) return line + '\n';
  for (std::string& choice : choices) choice += choice.ends_with(':') ? "…" : "";
  const std::string list = joined(choices, " ");
  if (columns(line) + 2 + columns(list) <= kDefault) return format("{}: {}\n", line, list);
  const bool fits_below = choices.size() > 1 && kOptionColumn + columns(list) <= kDefault;
  return fits_below ? format("{}:\n{:{}}{}\n", line, "", kOptionColumn, list) : line + '\n';
}

}  // namespace

std::string brief(std::string_view summary) {
  for (const std::string_view end : {". ", " (", ": ", "; "}) summary = summary.substr(0, summary.find(end));
  if (summary.ends_with('.')) summary.remove_suffix(1);
  return std::string(summary);
}

bool is_help_topic(std::string_view name) {
  return name == "all" || std::ranges::find(topics(), name, &Topic::name) != topics().end();
}

void print_version() { print_line("nutik-cl " NUTIK_VERSION); }

void print_help() {
  std::string text = wrapped(kWhatItIs, 0) +
                     "\n\n"
                     "  nutik-cl study clip.mp4                                    a motion study\n"
                     "  nutik-cl clip.mp4 clip.tik                                 encode a clip\n"
                     "  nutik-cl --start 0.4s --exposure 10ms clip.tik moment.png  expose an interval\n"
                     "  nutik-cl -m mask.pgm -k functions.fn clip.tik out.png      expose by functions\n"
                     "\n";
  for (const std::string_view group : kCommandGroups) {
    if (group == kOther) continue;
    text += format("{}:\n", group);
    for (const Command* command : commands_of(group)) {
      text += format("  {:<{}}{}\n", command->name, kCommandColumn - 2,
                     wrapped(brief(command->summary), kCommandColumn));
    }
  }
  text += "\nAlso: ";
  for (const Command* command : commands_of(kOther)) text += format("{}, ", command->name);
  text += "help [COMMAND], version; ./info is a file.\n"
          "In a window: nutik-studio. More: nutik-cl COMMAND --help, man nutik-cl, docs/.\n"
          "A fault? Report it with what 'nutik-cl devices --json' prints.";
  print_line(text);
}

void print_command_help(const Command& command, std::string_view topic) {
  std::string text = usage(command);
  std::string_view heading;
  if (topic.empty()) {
    text += '\n' + short_examples(command) + '\n';
    const std::vector<const Option*> own = options_of_its_own(command);
    for (const Option* option : own) {
      if (option->heading != heading) text += format("{}:\n", heading = option->heading);
      text += short_lines(*option);
    }
    text += format("\nMore: nutik-cl {} --help=all", command.name);
    for (const Topic& each : topics()) {
      const auto of_topic = options_of_topic(command, each.name);
      const bool is_shown = std::ranges::all_of(of_topic, [&](const Option* option) {
        return std::ranges::find(own, option) != own.end();
      });
      if (!is_shown) text += format(", ={}", each.name);
    }
  } else {
    for (const Option* option : options_of_topic(command, topic)) {
      if (option->heading != heading) text += format("\n{}:\n", heading = option->heading);
      text += option_lines(*option);
    }
    text += "\nExamples:\n";
    for (const std::string& example : parts_of(command.examples, '\n')) text += example_lines(example);
    text.pop_back();
  }
  print_line(text);
}

}  // namespace nutik::app
