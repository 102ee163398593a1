// Signals: what was begun is ended in good order, or leaves nothing but its temporary file.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "support/clips.hpp"
#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::Scratch;
namespace fs = std::filesystem;

// The program in the background.
class Running {
 public:
  // `ignored` is a signal that it is started with as under nohup; 0: none.
  Running(std::vector<std::string> words, const fs::path& folder, int ignored = 0) {
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
  ~Running() {
    if (process_ > 0) end_with(SIGKILL);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  // Waits until something has happened, and returns whether it did before the program ended.
  bool reaches(const std::function<bool()>& happened) const {
    while (!happened()) {
      siginfo_t ended{};
      waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT);
      if (ended.si_pid != 0) return happened();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }

  // Whether the program has a handler for the signal already.
  [[nodiscard]] bool catches(int signal) const {
    std::ifstream status("/proc/" + std::to_string(process_) + "/status");
    for (std::string word; status >> word;) {
      if (word != "SigCgt:") continue;
      std::string mask;
      status >> mask;
      return (std::stoull(mask, nullptr, 16) >> (signal - 1) & 1) != 0;
    }
    return false;
  }

  [[nodiscard]] bool takes(int signal) const { return kill(process_, signal) == 0; }

  // The exit status after a signal, or minus the number of the signal that ended it.
  int end_with(int signal) {
    kill(process_, signal);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t process_ = -1;
};

std::vector<fs::path> files_with(const fs::path& folder, const std::string& part) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().find(part) != std::string::npos) files.push_back(entry.path());
  }
  return files;
}

// Of what is not whole yet.
std::uintmax_t bytes_so_far(const fs::path& folder) {
  std::uintmax_t most = 0;
  for (const fs::path& file : files_with(folder, ".part")) {
    std::error_code gone;
    const std::uintmax_t bytes = fs::file_size(file, gone);
    if (!gone) most = std::max(most, bytes);
  }
  return most;
}

bool has_begun_writing(const fs::path& folder) { return bytes_so_far(folder) > 0; }

class Interruption : public testing::Test {
 protected:
  // Hours of video without a header: a hole on the disk, all black.
  void make_long_clip() const {
    std::ofstream(scratch_ / "long.raw").close();
    fs::resize_file(scratch_ / "long.raw", 64ull << 30);
  }
  std::vector<std::string> long_clip(std::vector<std::string> words) const {
    words.insert(words.end(), {"--raw", "256x256:gray", "-f", "1000", "long.raw"});
    return words;
  }

  // A capture that a hundred thousand frames can be made of.
  void make_capture() const {
    std::ofstream(scratch_ / "short.raw").close();
    fs::resize_file(scratch_ / "short.raw", 64 * 64 * 16);
    const auto made =
        test::run_program({"--raw", "64x64:gray", "-f", "8", "short.raw", "c.tik"}, scratch_.folder());
    ASSERT_EQ(made.status, 0) << made.err;
  }
  static std::vector<std::string> long_video(const std::string& output) {
    return {"video", "--renderer", "reference", "--out-fps", "1000", "--speed", "0.02", "c.tik", output};
  }

  Scratch scratch_;
};

TEST_F(Interruption, EndsAVideoAfterTheFramesSoFar) {
  make_capture();
  Running running(long_video("v.mkv"), scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }))
      << test::read_file(scratch_ / "log");
  EXPECT_FALSE(fs::exists(scratch_ / "v.mkv"));
  EXPECT_EQ(running.end_with(SIGINT), 128 + SIGINT);
  EXPECT_TRUE(files_with(scratch_.folder(), ".part").empty());
  const auto clip = test::open_test_clip(scratch_ / "v.mkv");
  const std::size_t frames = test::read_all(*clip).size();
  EXPECT_GT(frames, 0u);
  const std::string log = test::read_file(scratch_ / "log");
  EXPECT_NE(log.find("v.mkv: " + std::to_string(frames) + " of 100000 frames were written"),
            std::string::npos)
      << log;
  EXPECT_NE(log.find("nutik-cl: interrupted"), std::string::npos) << log;
}

TEST_F(Interruption, LeavesOnlyTheTemporaryFileOfAVideoThatIsKilled) {
  make_capture();
  Running running(long_video("v.mkv"), scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }))
      << test::read_file(scratch_ / "log");
  EXPECT_EQ(running.end_with(SIGKILL), -SIGKILL);
  EXPECT_FALSE(fs::exists(scratch_ / "v.mkv"));
  EXPECT_EQ(files_with(scratch_.folder(), ".v.mkv.").size(), 1u);
}

TEST_F(Interruption, KeepsTheStillsThatAreWhole) {
  make_capture();
  Running running(long_video("f-%d.pgm"), scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return fs::exists(scratch_ / "f-2.pgm"); }))
      << test::read_file(scratch_ / "log");
  EXPECT_EQ(running.end_with(SIGTERM), 128 + SIGTERM);
  EXPECT_TRUE(files_with(scratch_.folder(), ".part").empty());
  for (const fs::path& still : files_with(scratch_.folder(), "f-")) {
    EXPECT_EQ(fs::file_size(still), std::string("P5\n64 64\n255\n").size() + 64 * 64) << still;
  }
}

TEST_F(Interruption, RemovesACaptureThatIsNotWhole) {
  make_long_clip();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Running running(long_clip({"encode", "-o", "c.tik"}), scratch_.folder());
    ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }))
        << test::read_file(scratch_ / "log");
    EXPECT_EQ(running.end_with(signal), 128 + signal);
    EXPECT_TRUE(files_with(scratch_.folder(), "c.tik").empty());
  }
}

TEST_F(Interruption, EndsAnExposureOfAClip) {
  make_long_clip();
  Running running(
      long_clip({"expose", "--start", "0s", "--exposure", "800s", "-o", "p.png", "--renderer", "reference"}),
      scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return running.catches(SIGTERM); })) << test::read_file(scratch_ / "log");
  EXPECT_EQ(running.end_with(SIGTERM), 128 + SIGTERM);
  EXPECT_TRUE(files_with(scratch_.folder(), "p.png").empty());
}

// As under nohup: what SIGHUP would have ended goes on, until somebody asks for its end in another way.
TEST_F(Interruption, LeavesAnIgnoredSignalIgnored) {
  make_capture();
  Running running(long_video("v.mkv"), scratch_.folder(), SIGHUP);
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }))
      << test::read_file(scratch_ / "log");
  const std::uintmax_t before = bytes_so_far(scratch_.folder());
  ASSERT_TRUE(running.takes(SIGHUP));
  EXPECT_TRUE(running.reaches([&] { return bytes_so_far(scratch_.folder()) > before; }))
      << test::read_file(scratch_ / "log");
  ASSERT_FALSE(fs::exists(scratch_ / "v.mkv"));
  EXPECT_EQ(running.end_with(SIGINT), 128 + SIGINT);
  EXPECT_TRUE(fs::exists(scratch_ / "v.mkv"));
}

}  // namespace
}  // namespace nutik
