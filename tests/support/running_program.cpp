#include "support/running_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

namespace nutik::test {

namespace fs = std::filesystem;

RunningProgram::RunningProgram(std::vector<std::string> words, const fs::path& folder, int ignored) {
  words.insert(words.begin(), NUTIK_TEST_PROGRAM);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string log = folder / "log";
  process_ = fork();
  if (process_ != 0) return;
  // A test that runs in the background of a shell has SIGINT ignored, and its children with it.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, signal == ignored ? SIG_IGN : SIG_DFL);
  const int out = open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0666);
  dup2(out, 1);
  dup2(out, 2);
  if (chdir(folder.c_str()) == 0) execv(arguments[0], arguments.data());
  _exit(127);
}

RunningProgram::~RunningProgram() {
  if (process_ > 0) end_with(SIGKILL);
}

bool RunningProgram::reaches(const std::function<bool()>& happened) const {
  while (!happened()) {
    siginfo_t ended{};
    waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (ended.si_pid != 0) return happened();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

bool RunningProgram::catches(int signal) const {
  std::ifstream status("/proc/" + std::to_string(process_) + "/status");
  for (std::string word; status >> word;) {
    if (word != "SigCgt:") continue;
    std::string mask;
    status >> mask;
    return (std::stoull(mask, nullptr, 16) >> (signal - 1) & 1) != 0;
  }
  return false;
}

int RunningProgram::end() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

int RunningProgram::end_with(int signal) {
  kill(process_, signal);
  return end();
}

std::vector<fs::path> files_with(const fs::path& folder, const std::string& part) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().find(part) != std::string::npos) files.push_back(entry.path());
  }
  return files;
}

std::uintmax_t bytes_so_far(const fs::path& folder) {
  std::uintmax_t most = 0;
  for (const fs::path& file : files_with(folder, ".part")) {
    std::error_code gone;
    const std::uintmax_t bytes = fs::file_size(file, gone);
    if (!gone) most = std::max(most, bytes);
  }
  return most;
}

}  // namespace nutik::test
