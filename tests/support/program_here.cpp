#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "app/run.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

// A stream of this process that goes elsewhere for as long as this lives.
class Redirected {
 public:
  Redirected(int stream, const std::filesystem::path& file, int flags) : stream_(stream), kept_(::dup(stream)) {
    const int target = ::open(file.c_str(), flags | O_CLOEXEC, 0600);
    if (kept_ < 0 || target < 0) throw std::runtime_error("a stream cannot be redirected");
    ::dup2(target, stream_);
    ::close(target);
  }
  Redirected(const Redirected&) = delete;
  Redirected& operator=(const Redirected&) = delete;
  ~Redirected() {
    ::dup2(kept_, stream_);
    ::close(kept_);
  }

 private:
  int stream_, kept_;
};

}  // namespace

ProgramResult run_here(const std::vector<std::string>& words, const std::filesystem::path& folder) {
  const Scratch streams;
  const std::filesystem::path before = std::filesystem::current_path();
  ::setenv("NUTIK_MODULES", std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path().c_str(), 0);
  std::vector<const char*> all{NUTIK_TEST_PROGRAM};
  for (const std::string& word : words) all.push_back(word.c_str());
  ProgramResult result;
  std::fflush(nullptr);
  {
    const Redirected in(STDIN_FILENO, "/dev/null", O_RDONLY);
    const Redirected out(STDOUT_FILENO, streams / "out", O_WRONLY | O_CREAT);
    const Redirected err(STDERR_FILENO, streams / "err", O_WRONLY | O_CREAT);
    std::filesystem::current_path(folder);
    result.status = app::run(all);
    std::fflush(nullptr);
    std::filesystem::current_path(before);
  }
  result.out = read_file(streams / "out");
  result.err = without_building(read_file(streams / "err"));
  return result;
}

}  // namespace nutik::test
