// The manual page, from the one table of commands and options: in the language of man(7), ASCII only.
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "app/command_line/help.hpp"
#include "app/output/console.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"

namespace nutik::app {
namespace {

// Text as troff takes it literally: UTF-8 by the names of its characters, nothing read as a request.
std::string escaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) {
      switch (text[i]) {
        case '\\': result += "\\e"; break;
        case '-': result += "\\-"; break;
        case '\'': result += "\\(aq"; break;
        case '^': result += "\\(ha"; break;
        case '~': result += "\\(ti"; break;
        case '.': result += result.empty() ? "\\&." : "."; break;
        default: result += text[i];
      }
      continue;
    }
    const int more = byte >= 0xf0 ? 3 : byte >= 0xe0 ? 2 : 1;
    std::uint32_t character = byte & (0x3f >> more);
    for (int k = 0; k < more && i + 1 < text.size(); ++k) {
      character = character << 6 | (static_cast<unsigned char>(text[++i]) & 0x3f);
    }
    result += format("\\[u{:04X}]", character);
  }
  return result;
}

std::string section(std::string_view title) { return format(".SH {}\n", title); }

// A term and what is said of it.
std::string item(const std::string& term, std::string_view text) {
  return format(".TP\n{}\n{}\n", term, escaped(text));
}

std::string bold(std::string_view text) { return format("\\fB{}\\fR", escaped(text)); }

std::string option_term(const Option& option) {
  std::string term;
  if (option.short_name != 0) term += bold(std::string{'-', option.short_name}) + ", ";
  term += bold(option.name());
  if (!option.is_flag()) term += format(" \\fI{}\\fR", escaped(option.value));
  return term;
}

std::string takers_of(const Option& option) {
  std::vector<std::string> takers;
  for (const Command& command : commands()) {
    if (option.is_of(command.id)) takers.emplace_back(command.name);
  }
  return takers.size() == commands().size() ? "all commands" : joined(takers);
}

std::string commands_section() {
  std::string text = section("COMMANDS");
  for (const std::string_view group : kCommandGroups) {
    text += format(".SS {}\n", escaped(group));
    for (const Command* command : commands_of(group)) {
      std::string term = bold(command->name);
      if (!command->operands.empty()) term += format(" \\fI{}\\fR", escaped(command->operands));
      text += item(term, command->summary);
    }
  }
  return text;
}

std::string options_section() {
  std::string text = section("OPTIONS");
  text += escaped("Brackets hold the commands that take an option.") + "\n";
  std::string_view group;
  for (const Option& option : schema()) {
    if (option.heading != group) text += format(".SS {}\n", escaped(group = option.heading));
    text += item(option_term(option), format("{} [{}]", option.help, takers_of(option)));
  }
  return text;
}

std::string examples_section() {
  std::string text = section("EXAMPLES");
  for (const Command& command : commands()) {
    text += format(".SS {}\n.nf\n", escaped(command.name));
    for (const std::string& example : parts_of(command.examples, '\n')) text += escaped(example) + "\n";
    text += ".fi\n";
  }
  return text;
}

std::string man_page() {
  std::string text =
      ".\\\" Written by nutik-cl man, from the table that the program reads its options with.\n";
  text += ".TH NUTIK\\-CL 1 \"\" \"nutik\\-cl " NUTIK_VERSION "\" \"User Commands\"\n";
  text += section("NAME") + "nutik\\-cl \\- exposes pictures after the scene was filmed\n";
  text += section("SYNOPSIS");
  for (const std::string_view form :
       {"CLIP CAPTURE.tik", "--start TIME --exposure TIME CAPTURE.tik PICTURE",
        "-m MASK.pgm -k FUNCTIONS.fn CAPTURE.tik PICTURE", "CAPTURE.tik", "COMMAND [OPTIONS] [FILES]"}) {
    text += format(".B nutik\\-cl\n{}\n.br\n", escaped(form));
  }
  text += section("DESCRIPTION") + escaped(kWhatItIs) + "\n.PP\n" +
          format("{}\n.PP\n.nf\n{}\n.fi\n.PP\n", escaped(kAboutFunctionFiles), kFunctionFile) +
          escaped(
              "Times have a unit: 0.4s, 10ms, 250us, 7ns, 2min, 1/100s, or 37f for pictures of the clip, "
              "counted from 0. Functions (-k) and masks (-m) are read from standard input where their name "
              "is -.") +
          "\n";
  text += commands_section() + options_section() + examples_section();
  text += section("EXIT STATUS");
  constexpr std::pair<std::string_view, std::string_view> kStatuses[] = {
      {"0", "done"},
      {"1", "anything unforeseen, or pictures of a batch that cannot be made"},
      {"2", "the command line makes no sense"},
      {"3", "an input cannot be read, is damaged or does not fit the others; mistakes that check found"},
      {"4", "the OpenCL device is absent or fails"},
      {"5", "an output cannot be written, or one of a batch"},
      {"6", "out of memory, or of threads"},
      {"7", "with --strict: a picture may err by more than half a code, or half a float's step"},
      {"128+n", "ended by signal n"}};
  for (const auto& [status, meaning] : kStatuses) text += item(bold(status), meaning);
  text += section("ENVIRONMENT");
  constexpr std::pair<std::string_view, std::string_view> kVariables[] = {
      {"NUTIK_DEVICE", "the OpenCL device or devices, as --device"},
      {"NUTIK_SELF_TEST", "off: kernels are not tested before they are used"},
      {"NUTIK_MODULES",
       "the folder of nutik-videos.so and the other modules, where they are not in their usual place"},
      {"NO_COLOR", "no colours on a terminal, whatever its value is, unless that is empty"},
      {"COLUMNS", "how wide help is, 60 to 100"},
      {"XDG_CACHE_HOME", "where built kernels are kept, in a folder nutik-cl (default: ~/.cache)"},
      {"TMPDIR", "where a clip that is read more than once is kept meanwhile"}};
  for (const auto& [name, meaning] : kVariables) text += item(bold(name), meaning);
  text += section("BUGS") +
          escaped(
              "Report a fault with what nutik-cl devices --json prints, the whole command line and the "
              "whole message; with -v it says more.") +
          "\n" + section("SEE ALSO") + ".BR nutik\\-studio (1),\n.BR ffmpeg (1),\n.BR clinfo (1)\n";
  return text;
}

}  // namespace

int run_man(const Options& options) {
  if (!options.operands.empty()) throw UsageError("man takes no file: nutik-cl man > nutik-cl.1");
  print_text(man_page());
  return 0;
}

}  // namespace nutik::app
