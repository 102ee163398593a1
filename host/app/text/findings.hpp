// What a check found: mistakes and warnings, for people or for a script.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/output/json.hpp"
#include "session/functions.hpp"

namespace nutik::app {

struct Finding {
  using Severity = Diagnostic::Severity;

  Severity severity = Severity::error;
  std::string kind;                               // for scripts: `mistyped_time`
  std::string file;                               // the input it is about
  std::string message;                            // without the file's name
  std::optional<TextPlace> place = std::nullopt;  // in a function file
  Excerpt excerpt = {};
  Json details = Json::object();  // more for scripts: `mask_value`, …

  [[nodiscard]] std::string text() const;
  [[nodiscard]] Json json() const;
};

class Findings {
 public:
  void add(Finding finding) { findings_.push_back(std::move(finding)); }

  [[nodiscard]] std::size_t count(Finding::Severity severity) const;
  // All of them, one below the other; of each kind at most 20 in each file, then how many more there are.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] Json json() const;
  // `1 mistake, 2 warnings`, `nothing wrong`.
  [[nodiscard]] std::string verdict() const;

 private:
  std::vector<Finding> findings_;
};

}  // namespace nutik::app
