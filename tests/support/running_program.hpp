// The program in the background.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace nutik::test {

class RunningProgram {
 public:
  // Runs nutik-cl with these words in `folder`, where what it prints goes to a file `log`. `ignored` is a signal that
  // it is started with as under nohup; 0: none.
  RunningProgram(std::vector<std::string> words, const std::filesystem::path& folder, int ignored = 0);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  // Waits until something has happened, and returns whether it did before the program ended.
  bool reaches(const std::function<bool()>& happened) const;

  // Whether the program has a handler for the signal already.
  [[nodiscard]] bool catches(int signal) const;
  [[nodiscard]] bool takes(int signal) const { return kill(process_, signal) == 0; }

  // The exit status, or minus the number of the signal that ended it.
  int end();
  // The same after a signal.
  int end_with(int signal);

 private:
  pid_t process_ = -1;
};

[[nodiscard]] std::vector<std::filesystem::path> files_with(const std::filesystem::path& folder,
                                                            const std::string& part);

// Counts what is not whole yet.
[[nodiscard]] std::uintmax_t bytes_so_far(const std::filesystem::path& folder);
[[nodiscard]] inline bool has_begun_writing(const std::filesystem::path& folder) {
  return bytes_so_far(folder) > 0;
}

}  // namespace nutik::test
