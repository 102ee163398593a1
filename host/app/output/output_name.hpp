// Where a command writes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line/options.hpp"
#include "session/output_check.hpp"

namespace nutik::app {

// The output that was asked for: -o or the second operand. Throws UsageError where both were given, or there are no
// operands, or more than `command` takes.
[[nodiscard]] std::optional<std::filesystem::path> stated_output(const Options& options,
                                                                 std::string_view command);
// The same, else a name made from the input's: `clip-motion.png` with `-motion.png` behind it.
[[nodiscard]] std::filesystem::path output_name(const Options& options, std::string_view command,
                                                std::string_view behind);

// Whether standard output takes a picture, so that nothing else may go there. Throws UsageError where something must.
[[nodiscard]] bool writes_to_standard_output(const Options& options);

// The files that a command reads, each still of a sequence among them: no output may replace one. Its first operand is
// one of them, where it has any.
[[nodiscard]] std::vector<std::string> input_files(const Options& options);

}  // namespace nutik::app
