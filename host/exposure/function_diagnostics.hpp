// What is wrong with a function file: for each mistake its place, what is wrong, what would be right, and
// the line.
//
//   always:  in the order of the text; of each severity at most kMaxShown are kept, the first in the
//            file, and the others are counted: a file of a million mistakes costs no more than one of 20
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "capture/source_text.hpp"

namespace nutik {

struct Diagnostic {
  enum class Severity { error, warning };

  Severity severity = Severity::error;
  TextPlace place;
  std::string message;
  Excerpt excerpt;

  // `motion.fn:3:14: time 1000000 is not after 2000000; …`, the line, and a mark under the place.
  [[nodiscard]] std::string text(std::string_view file_name) const;
};

class Diagnostics {
 public:
  static constexpr std::size_t kMaxShown = 20;

  // Where several stand at one place, the first added comes first.
  void add(Diagnostic::Severity severity, const SourceText& source, std::size_t at, std::string message);

  [[nodiscard]] const std::vector<Diagnostic>& shown() const { return shown_; }
  // All of them, also those that are not shown.
  [[nodiscard]] std::size_t count(Diagnostic::Severity severity) const {
    return counts_[static_cast<std::size_t>(severity)];
  }

  // Those of both severities, one below the other, and how many more there are. Empty where there
  // are none.
  [[nodiscard]] std::string report(std::string_view file_name) const;

 private:
  std::vector<Diagnostic> shown_;
  std::array<std::size_t, 2> counts_{};
};

}  // namespace nutik
