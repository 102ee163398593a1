// Function files: gain functions as people write them. docs/functions.md has the format.
//
//   M0 [0:1], [10000000:1], [10000001:0]          one line without braces
//   M128{[0:0], [399999999:0],                    or braces, over as many lines as it takes
//        [400000000:1]}
//
// Every mistake in a file is found, not just the first, each with its place and the line itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "exposure/gain_function.hpp"

namespace nutik {

// A place in a text, counted from 1 as editors do; columns count bytes.
struct TextPlace {
  std::size_t line = 0;
  std::size_t column = 0;
  friend bool operator==(const TextPlace&, const TextPlace&) = default;
};

struct Diagnostic {
  enum class Severity { error, warning };

  Severity severity = Severity::error;
  TextPlace place;
  std::string message;
  std::string source_line;

  // `motion.fn:3:14: time 1000000 is not after 2000000; …`, the line, and a mark under the place.
  [[nodiscard]] std::string text(std::string_view file_name) const;
};

struct FileFunction {
  GainFunction function;
  TextPlace place;                        // of its `M`
  std::vector<TextPlace> point_places;    // of each control point's time
};

struct FunctionFile {
  std::map<std::uint8_t, FileFunction> functions;  // by mask value
  std::vector<Diagnostic> diagnostics;             // in the order of the text

  [[nodiscard]] bool has_errors() const;
  // All diagnostics of one severity, one below the other.
  [[nodiscard]] std::string report(Diagnostic::Severity severity, std::string_view file_name) const;
};

// Reads a whole function file. Functions with errors are left out of `functions`.
[[nodiscard]] FunctionFile parse_functions(std::string_view text);

}  // namespace nutik
