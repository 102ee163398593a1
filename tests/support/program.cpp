#include "support/program.hpp"

#include <sys/wait.h>

#include <cstdlib>

#include "support/scratch.hpp"

namespace nutik::test {
namespace {

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

ProgramResult run_shell(const std::string& command, const std::filesystem::path& folder) {
  const Scratch streams;
  const std::string line = "cd " + quoted(folder.string()) + " && " + command + " >" +
                           quoted((streams / "out").string()) + " 2>" + quoted((streams / "err").string()) +
                           " </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(streams / "out"),
          read_file(streams / "err")};
}

ProgramResult run_program(const std::vector<std::string>& words, const std::filesystem::path& folder,
                          const std::vector<std::string>& environment) {
  std::string command = "env";
  for (const std::string& setting : environment) command += " " + quoted(setting);
  command += " " + quoted(NUTIK_TEST_PROGRAM);
  for (const std::string& word : words) command += " " + quoted(word);
  return run_shell(command, folder);
}

}  // namespace nutik::test
