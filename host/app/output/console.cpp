#include "app/output/console.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string_view>

#include "capture/error.hpp"
#include "capture/source_text.hpp"

namespace nutik::app {
namespace {

constexpr const char* kRed = "\x1b[1;31m";
constexpr const char* kYellow = "\x1b[1;33m";
constexpr const char* kPlain = "\x1b[0m";

// Where lines of a result go.
std::FILE* line_stream = stdout;

std::mutex warnings_mutex;
std::vector<std::string> warnings_so_far;

void write_line(std::FILE* stream, const std::string& text) {
  std::fprintf(stream, "%s\n", text.c_str());
  std::fflush(stream);
}

// Only for eyes: on a terminal that knows colours, unless NO_COLOR (no-color.org) says otherwise.
bool has_colours() {
  static const bool result = [] {
    const char* no_colour = std::getenv("NO_COLOR");
    const char* terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && (no_colour == nullptr || *no_colour == '\0') &&
           terminal != nullptr && std::string_view(terminal) != "dumb";
  }();
  return result;
}

// A message behind a word that says what it is.
void write_message(const char* colour, const std::string& label, const std::string& text) {
  write_line(stderr, (has_colours() ? colour + label + kPlain : label) + " " + printable_lines(text));
}

}  // namespace

void print_line(const std::string& text) { write_line(line_stream, printable_lines(text)); }
void print_text(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}
void print_warning(const std::string& text) {
  const std::scoped_lock lock(warnings_mutex);
  write_message(kYellow, "warning:", text);
  warnings_so_far.push_back(text);
}
std::vector<std::string> printed_warnings() {
  const std::scoped_lock lock(warnings_mutex);
  return warnings_so_far;
}
void print_error(const std::string& text) { write_message(kRed, "nutik-cl:", text); }
void print_note(const std::string& text) { write_line(stderr, printable_lines(text)); }
void print_warnings(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) print_warning(text);
}
void print_notes(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) print_note("note: " + text);
}

void keep_lines_from_output(bool keep) { line_stream = keep ? stderr : stdout; }

void flush_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw OutputError("standard output cannot be written");
}

}  // namespace nutik::app
