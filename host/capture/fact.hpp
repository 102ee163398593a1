// What is known of a capture beside its samples, and who said it.
#pragma once

#include <string>

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

}  // namespace nutik
