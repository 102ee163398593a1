#include "app/command_line/help.hpp"

#include <string>
#include <string_view>
#include <vector>

#include "app/output/console.hpp"
#include "capture/format.hpp"

#ifndef NUTIK_VERSION
#error "NUTIK_VERSION is not set"
#endif

namespace nutik::app {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kOptionColumn = 32;

// Length on a terminal: bytes that continue a UTF-8 character take no column.
std::size_t columns(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return count;
}

// `text` in lines of at most kWidth, all but the first after `indent` blanks.
std::string wrapped(std::string_view text, std::size_t indent) {
  std::string result;
  std::size_t column = indent;
  while (!text.empty()) {
    const auto space = text.find(' ');
    const std::string_view word = text.substr(0, space);
    if (column > indent && column + 1 + columns(word) > kWidth) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += columns(word);
    text = space == std::string_view::npos ? std::string_view() : text.substr(space + 1);
  }
  return result;
}

std::string option_lines(const Option& option) {
  std::string names = "  ";
  names += option.short_name != 0 ? format("-{}, ", option.short_name) : "    ";
  names += format("--{}{}{}", option.long_name, option.value.empty() ? "" : " ", option.value);
  if (names.size() + 2 > kOptionColumn) {
    names += '\n' + std::string(kOptionColumn, ' ');
  } else {
    names.resize(kOptionColumn, ' ');
  }
  return names + wrapped(option.help, kOptionColumn) + '\n';
}

std::string example_lines(std::string_view examples) {
  std::string text;
  while (!examples.empty()) {
    const auto line_end = examples.find('\n');
    text += format("  {}\n", examples.substr(0, line_end));
    examples = line_end == std::string_view::npos ? std::string_view() : examples.substr(line_end + 1);
  }
  return text;
}

}  // namespace

void print_version() { print_line("nutik-cl " NUTIK_VERSION); }

void print_help() {
  std::string text =
      "nutik-cl exposes pictures after the scene was filmed. It turns a video into a capture (.tik), the\n"
      "record of when and how every pixel changed, and exposes pictures from it in which every region of\n"
      "a mask has its own gain as a function of time.\n"
      "\n"
      "  nutik-cl clip.mp4 clip.tik                                  encode a clip\n"
      "  nutik-cl --start 0.4s --exposure 10ms clip.tik moment.png   expose a plain interval\n"
      "  nutik-cl -m mask.pgm -k functions.fn clip.tik out.png       expose regions with gain functions\n"
      "  nutik-cl clip.tik                                           say what a capture holds\n"
      "\n"
      "A function file has a line for each mask value, times in nanoseconds: M0 [0:1], [10000000:1], "
      "[10000001:0]\n"
      "\n"
      "Commands (the forms above need none):\n";
  for (const Command& command : commands()) {
    text += format("  {:<10}{}\n", command.name, wrapped(command.summary, 12));
  }
  text +=
      "\n"
      "nutik-cl COMMAND --help shows a command's options. A file that is named like a command is written\n"
      "./info, or after --.";
  print_line(text);
}

void print_command_help(const Command& command) {
  std::string text =
      format("nutik-cl {} [OPTIONS]{}{}\n\n{}\n", command.name, command.operands.empty() ? "" : " ",
             command.operands, wrapped(command.summary, 0));
  std::vector<std::string_view> groups;
  for (const Option& option : options()) {
    if ((option.commands & bit(command.id)) == 0) continue;
    if (groups.empty() || groups.back() != option.group) {
      text += format("\n{}:\n", option.group);
      groups.push_back(option.group);
    }
    text += option_lines(option);
  }
  text += format("\nExamples:\n{}", example_lines(command.examples));
  text.pop_back();
  print_line(text);
}

}  // namespace nutik::app
