// Function files: gain functions as people write them. docs/reference/functions.md has the format.
//
//   M0 [0:1], [10000000:1], [10000001:0]          one line without braces
//   M128{[0:0], [399999999:0],                    or braces, over as many lines as it takes
//        [400000000:1]}
//   1f = 1/240s                                   how long a picture is, for times as 37f behind it
//
// Every mistake in a file is found, not just the first, each with its place and the line itself.
// The time this takes grows with the file's length and no faster, whatever is in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "exposure/function_diagnostics.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

struct FileFunction {
  GainFunction function;
  TextPlace place;                   // of its `M`
  std::size_t start_at = 0;          // the same, as an offset in the file's SourceText
  std::vector<std::size_t> time_at;  // of the control points' times there
};

struct FunctionFile {
  std::map<std::uint8_t, FileFunction> functions;  // by mask value
  std::set<std::uint8_t> broken;                   // mask values whose functions have errors
  Diagnostics diagnostics;

  [[nodiscard]] bool has_errors() const { return diagnostics.count(Diagnostic::Severity::error) > 0; }
  [[nodiscard]] std::string report(std::string_view file_name) const { return diagnostics.report(file_name); }
};

// Reads a whole function file. Functions with errors are left out of `functions`.
[[nodiscard]] FunctionFile parse_functions(std::string_view text);

}  // namespace nutik
