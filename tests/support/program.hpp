// Runs the program as a user does.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nutik::test {

struct ProgramResult {
  int status = -1;
  std::string out;
  std::string err;
};

// Runs nutik-cl with these words in `folder`; `environment` are NAME=value settings in front.
[[nodiscard]] ProgramResult run_program(const std::vector<std::string>& words,
                                        const std::filesystem::path& folder,
                                        const std::vector<std::string>& environment = {});

// The same in this process, which saves its start; there may be a state that an earlier run left. For tests that are
// linked to the program.
[[nodiscard]] ProgramResult run_here(const std::vector<std::string>& words, const std::filesystem::path& folder);

// What the program said, without that it built kernels: whichever test comes first is told so.
[[nodiscard]] std::string without_building(std::string err);

// A command's words where the files of an earlier one may be replaced.
[[nodiscard]] inline std::vector<std::string> over(std::vector<std::string> words) {
  words.emplace_back("--overwrite");
  return words;
}

// Any command line of a shell, for second programs that read what ours wrote.
[[nodiscard]] ProgramResult run_shell(const std::string& command, const std::filesystem::path& folder);

// Whether `script` can give a program a terminal here.
[[nodiscard]] bool has_pseudo_terminals();

}  // namespace nutik::test
