// What is known of a capture beside its samples, and who said it.
#pragma once

#include <string>
#include <string_view>

#include "capture/error.hpp"

namespace nutik {

enum class Origin { file, stated, assumed };

struct Fact {
  std::string text;  // `transfer srgb`
  Origin origin = Origin::file;
  Setting setting;                  // that says otherwise
  std::string source = "the file";  // what of the files says it
  std::string remark = {};          // what they say besides: `the file names bt709`

  // `transfer srgb, assumed; the file names bt709`.
  [[nodiscard]] std::string line() const {
    const std::string from = origin == Origin::file     ? "from " + source
                             : origin == Origin::stated ? "as stated"
                                                        : "assumed";
    return text + ", " + from + (remark.empty() ? "" : "; ") + remark;
  }
};

// What a line states, without who said so and what else was said.
[[nodiscard]] inline std::string_view statement_of(std::string_view line) {
  for (const std::string_view by : {", from ", ", as stated", ", assumed"}) line = line.substr(0, line.find(by));
  return line;
}

inline void restate(std::string& line, const std::string& statement) {
  line.replace(0, statement_of(line).size(), statement);
}

}  // namespace nutik
