#include "support/program.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "support/scratch.hpp"

namespace nutik::test {
namespace {

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string without_building(std::string err) {
  constexpr std::string_view kBuilding = "building and testing kernels for ";
  const std::size_t line = err.find(kBuilding);
  if (line == std::string::npos || (line > 0 && err[line - 1] != '\n')) return err;
  return err.erase(line, err.find('\n', line) + 1 - line);
}

ProgramResult run_shell(const std::string& command, const std::filesystem::path& folder) {
  const Scratch streams;
  const std::string line = "cd " + quoted(folder.string()) + " && " + command + " >" +
                           quoted((streams / "out").string()) + " 2>" + quoted((streams / "err").string()) +
                           " </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(streams / "out"),
          read_file(streams / "err")};
}

bool has_pseudo_terminals() { return run_shell("script -qec true /dev/null", "/").status == 0; }

ProgramResult run_program(const std::vector<std::string>& words, const std::filesystem::path& folder,
                          const std::vector<std::string>& environment) {
  std::string command = "env";
  for (const std::string& setting : environment) command += " " + quoted(setting);
  command += " " + quoted(NUTIK_TEST_PROGRAM);
  for (const std::string& word : words) command += " " + quoted(word);
  ProgramResult result = run_shell(command, folder);
  const bool has_own_cache = std::ranges::any_of(
      environment, [](const std::string& setting) { return setting.starts_with("XDG_CACHE_HOME="); });
  if (!has_own_cache) result.err = without_building(std::move(result.err));
  return result;
}

}  // namespace nutik::test
