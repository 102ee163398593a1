// Function files with names in the place of numbers that are to be found.
//
//   M0{[0:0], [1:1], [1000000000:1], [1000000001:rest], [1010000000:rest], [1010000001:0]}
//   M1 [when:0], [when+1:1], [when+10000000:1], [when+10000001:0]
//
//   always:  a name begins with a letter and is one of a gain or one of a time. With numbers in place of names the text
//            is a function file, and differs from what was read in nothing else
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exposure/function_diagnostics.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

struct TemplatePoint {
  std::int64_t time_ns = 0;                         // of a named time what is added to it
  double gain = 0.0;                                // 0 where it is named
  std::optional<std::size_t> time_name, gain_name;  // in FunctionTemplate::times and gains
};

// What names stand for, in the order of FunctionTemplate::gains and times.
struct NamedNumbers {
  std::vector<double> gains;
  std::vector<std::int64_t> times_ns;
};

struct FunctionTemplate {
  // A name in the text, from `begin` up to `end`.
  struct Place {
    std::size_t begin = 0, end = 0;
    std::optional<std::size_t> time, gain;  // which of them it is
    std::int64_t added_ns = 0;              // to a time
  };

  std::string text;
  std::vector<std::string> gains, times;                         // names, in the order of the text
  std::map<std::uint8_t, std::vector<TemplatePoint>> functions;  // by mask value
  std::vector<Place> places;                                     // in the order of the text
  Diagnostics diagnostics;

  [[nodiscard]] bool has_errors() const { return diagnostics.count(Diagnostic::Severity::error) > 0; }

  // A function's control points with times in place of names, gains being 0 where they are named; none where times are
  // out of order then.
  [[nodiscard]] static std::optional<std::vector<ControlPoint>> points(
      const std::vector<TemplatePoint>& function, const std::vector<std::int64_t>& times_ns);
  // The function file with numbers in place of names.
  [[nodiscard]] std::string text_with(const NamedNumbers& numbers) const;
};

// Reads a whole file, as parse_functions() does (exposure/function_file.hpp), and names.
[[nodiscard]] FunctionTemplate parse_template(std::string_view text);

}  // namespace nutik
