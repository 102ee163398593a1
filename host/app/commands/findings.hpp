// What a check found: mistakes and warnings, for people or for a script.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/output/report.hpp"
#include "features/check/input_check.hpp"

namespace nutik::app {

[[nodiscard]] std::size_t count_of(const std::vector<Finding>& findings, Finding::Severity severity);
// All of them, one below the other; of each kind at most 20 in each file, then how many more there are.
[[nodiscard]] std::string findings_text(const std::vector<Finding>& findings);
[[nodiscard]] Json findings_json(const std::vector<Finding>& findings);
// `1 mistake, 2 warnings`, `nothing wrong`.
[[nodiscard]] std::string verdict(const std::vector<Finding>& findings);

}  // namespace nutik::app
