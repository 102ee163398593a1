// The only place that prints.
#pragma once

#include <string>
#include <vector>

namespace nutik::app {

// All but print_text() print what can be seen (printable_lines()): names and texts of strangers are among it.
void print_line(const std::string& text);     // result, to stdout
void print_text(const std::string& text);     // result that ends its own lines, to stdout
void print_warning(const std::string& text);  // to stderr, behind "warning:", in colour on a terminal
void print_error(const std::string& text);    // to stderr, behind "nutik-cl:", likewise
void print_note(const std::string& text);     // to stderr
void print_warnings(const std::vector<std::string>& texts);
// All of them so far, for --json. Any thread may warn.
[[nodiscard]] std::vector<std::string> printed_warnings();
void print_notes(const std::vector<std::string>& texts);  // each behind "note:"

// Whether lines go to stderr from now on: standard output is for the result itself.
void keep_lines_from_output(bool keep);

// Throws OutputError where standard output could not be written, to a full disk for example.
void flush_output();

}  // namespace nutik::app
