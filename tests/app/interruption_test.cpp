// Signals: what was begun is ended in good order, or leaves nothing but its temporary file.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/program.hpp"
#include "support/running_program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

using Running = RunningProgram;
namespace fs = std::filesystem;

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
    const auto made = run_program({"--raw", "64x64:gray", "-f", "8", "short.raw", "c.tik"}, scratch_.folder());
    ASSERT_EQ(made.status, 0) << made.err;
  }
  static std::vector<std::string> long_video(const std::string& output) {
    return {"video",   "--renderer", "reference",   "--out-fps", "1000",
            "--speed", "0.02",       "--no-recipe", "c.tik",     output};
  }

  Scratch scratch_;
};

TEST_F(Interruption, EndsAVideoAfterTheFramesSoFar) {
  make_capture();
  Running running(long_video("v.mkv"), scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); })) << read_file(scratch_ / "log");
  EXPECT_FALSE(fs::exists(scratch_ / "v.mkv"));
  EXPECT_EQ(running.end_with(SIGINT), 128 + SIGINT);
  EXPECT_TRUE(files_with(scratch_.folder(), ".part").empty());
  const auto clip = open_test_clip(scratch_ / "v.mkv");
  const std::size_t frames = read_all(*clip).size();
  EXPECT_GT(frames, 0u);
  const std::string log = read_file(scratch_ / "log");
  expect_says(log, "v.mkv: " + std::to_string(frames) + " of 100000 frames were written");
  expect_says(log, "nutik-cl: interrupted");
}

TEST_F(Interruption, EndsALongSearchForTimes) {
  make_capture();
  scratch_.write("moved.fn",
                 "M0 [a:0], [a+1:g], [a+1000:g], [a+1001:0], [b:0], [b+1:1], [b+1000:1], [b+1001:0]");
  Running running({"solve", "-k", "moved.fn", "--free", "a=0s..0.9s/1ms", "--free", "b=1s..1.9s/1ms",
                   "--wish", "all = 0.5", "c.tik"},
                  scratch_.folder());
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(running.end_with(SIGTERM), 128 + SIGTERM) << read_file(scratch_ / "log");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
  EXPECT_FALSE(fs::exists(scratch_ / "moved-solved.fn"));
}

TEST_F(Interruption, LeavesOnlyTheTemporaryFileOfAVideoThatIsKilled) {
  make_capture();
  Running running(long_video("v.mkv"), scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); })) << read_file(scratch_ / "log");
  EXPECT_EQ(running.end_with(SIGKILL), -SIGKILL);
  EXPECT_FALSE(fs::exists(scratch_ / "v.mkv"));
  EXPECT_EQ(files_with(scratch_.folder(), ".v.mkv.nutik-").size(), 1u);
}

TEST_F(Interruption, KeepsTheStillsThatAreWhole) {
  make_capture();
  Running running(long_video("f-%d.pgm"), scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return fs::exists(scratch_ / "f-2.pgm"); })) << read_file(scratch_ / "log");
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
    ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); })) << read_file(scratch_ / "log");
    EXPECT_EQ(running.end_with(signal), 128 + signal);
    EXPECT_TRUE(files_with(scratch_.folder(), "c.tik").empty());
  }
}

TEST_F(Interruption, RemovesAJoinedCaptureThatIsNotWhole) {
  // As if it were files that follow each other: none says where in a clip it lies.
  std::ofstream(scratch_ / "short.raw").close();
  fs::resize_file(scratch_ / "short.raw", 256 * 256 * 8);
  const auto made =
      run_program({"--raw", "256x256:gray", "-f", "1000", "--codec", "none", "short.raw", "c.tik"}, scratch_.folder());
  ASSERT_EQ(made.status, 0) << made.err;
  std::vector<std::string> words{"join"};
  words.insert(words.end(), 30'000, "c.tik");
  words.insert(words.end(), {"-o", "j.tik"});
  Running running(words, scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); })) << read_file(scratch_ / "log");
  EXPECT_EQ(running.end_with(SIGTERM), 128 + SIGTERM);
  EXPECT_TRUE(files_with(scratch_.folder(), "j.tik").empty());
}

TEST_F(Interruption, EndsAnExposureOfAClip) {
  make_long_clip();
  Running running(
      long_clip({"expose", "--start", "0s", "--exposure", "800s", "-o", "p.png", "--renderer", "reference"}),
      scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return running.catches(SIGTERM); })) << read_file(scratch_ / "log");
  EXPECT_EQ(running.end_with(SIGTERM), 128 + SIGTERM);
  EXPECT_TRUE(files_with(scratch_.folder(), "p.png").empty());
}

// As under nohup: what SIGHUP would have ended goes on, until somebody asks for its end in another way.
TEST_F(Interruption, LeavesAnIgnoredSignalIgnored) {
  make_capture();
  Running running(long_video("v.mkv"), scratch_.folder(), SIGHUP);
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); })) << read_file(scratch_ / "log");
  const std::uintmax_t before = bytes_so_far(scratch_.folder());
  ASSERT_TRUE(running.takes(SIGHUP));
  EXPECT_TRUE(running.reaches([&] { return bytes_so_far(scratch_.folder()) > before; })) << read_file(scratch_ / "log");
  ASSERT_FALSE(fs::exists(scratch_ / "v.mkv"));
  EXPECT_EQ(running.end_with(SIGINT), 128 + SIGINT);
  EXPECT_TRUE(fs::exists(scratch_ / "v.mkv"));
}

}  // namespace
}  // namespace nutik::test
