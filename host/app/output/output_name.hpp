// Where a command writes.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/command_line/options.hpp"
#include "session/output_check.hpp"

namespace nutik::app {

// The output that was asked for: -o or the second operand. Throws UsageError where both were given, or
// there are more operands than `command` takes.
[[nodiscard]] std::optional<std::filesystem::path> stated_output(const std::optional<std::string>& option,
                                                                 std::span<const std::string> operands,
                                                                 const std::string& command);

// The name of a picture of `input` that nobody gave one: `clip-motion.png` for the exposure `motion`.
[[nodiscard]] std::filesystem::path picture_name(const std::string& input, const std::string& label);

// The files that a command reads, each still of a sequence among them: no output may replace one. Its first operand is
// one of them, where it has any.
[[nodiscard]] std::vector<std::string> input_files(const Options& options);

}  // namespace nutik::app
