#include "app/output/console.hpp"

#include <cstdio>

#include "capture/error.hpp"

namespace nutik::app {
namespace {

void write_line(std::FILE* stream, const char* before, const std::string& text) {
  std::fprintf(stream, "%s%s\n", before, text.c_str());
  std::fflush(stream);
}

}  // namespace

void print_line(const std::string& text) { write_line(stdout, "", text); }
void print_warning(const std::string& text) { write_line(stderr, "warning: ", text); }
void print_error(const std::string& text) { write_line(stderr, "nutik-cl: ", text); }
void print_note(const std::string& text) { write_line(stderr, "", text); }

void flush_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw OutputError("standard output cannot be written");
  }
}

}  // namespace nutik::app
