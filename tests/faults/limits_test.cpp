// Limits of the shell, and readers that are gone: told where that can be, and nothing is left behind.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <random>

#include "capture/format.hpp"
#include "support/program_test.hpp"
#include "support/running_program.hpp"

namespace nutik::test {
namespace {

namespace fs = std::filesystem;

class Limits : public ProgramTest {
 protected:
  // Noise, which no codec makes small.
  void SetUp() override {
    std::ofstream noise(scratch_ / "clip.raw", std::ios::binary);
    std::minstd_rand random(1);
    for (int i = 0; i < 64 * 64 * 64; ++i) noise.put(static_cast<char>(random() >> 8));
    fs::create_directory(scratch_ / "temporary");
  }
  // The program's words behind those of a shell.
  [[nodiscard]] ProgramResult run_below(const std::string& shell, const std::string& words) const {
    return run_shell(format("(export TMPDIR=\"$PWD/temporary\"; {} '{}' {})", shell, NUTIK_TEST_PROGRAM, words),
                     scratch_.folder());
  }
  void expect_nothing_left() const {
    EXPECT_TRUE(files_with(scratch_.folder(), ".part").empty());
    EXPECT_TRUE(fs::is_empty(scratch_ / "temporary"));
  }
  static constexpr const char* kClip = "--raw 64x64:gray -f 64 clip.raw";
};

// As on a disk that is full. Blocks of ulimit have 512 bytes, in some shells 1024.
TEST_F(Limits, OfAFilesSizeAreErrorsOfItsWriting) {
  for (const std::string& words :
       {format("encode {} -o out.tik", kClip), format("video {} out.mkv", kClip)}) {
    SCOPED_TRACE(words);
    const auto result = run_below("ulimit -f 20;", words);
    EXPECT_EQ(result.status, 5) << result.err;
    expect_says(result.err, "File too large");
    EXPECT_EQ(result.err.find("/proc/"), std::string::npos) << result.err;
    EXPECT_TRUE(files_with(scratch_.folder(), "out.").empty());
    expect_nothing_left();
  }
}

// Drivers and decoders would crash.
TEST_F(Limits, OfAStackAreTold) {
  for (const std::string& words : {std::string("--help"), format("encode {} -o out.tik", kClip),
                                   format("--start 0f --exposure 1f {} out.png", kClip)}) {
    SCOPED_TRACE(words);
    const auto result = run_below("ulimit -s 64;", words);
    EXPECT_EQ(result.status, 6) << result.err;
    expect_says(result.err, "raise its limit: ulimit -s");
    EXPECT_EQ(run_below("ulimit -s 256;", words).status, 0);
  }
}

// Nobody reads the lines of progress any more: the end that other programs have then, 128 + 13 to a shell.
TEST_F(Limits, OfAReadersPatienceLeaveNoTemporaryFile) {
  const auto made = run_below("", format("encode {} c.tik", kClip));
  ASSERT_EQ(made.status, 0) << made.err;
  const auto result = run_shell(format("{{ {{ '{}' video --progress --out-fps 1000 --speed 0.01 c.tik "
                                       "out.mkv; echo $? > status; }} 2>&1 | "
                                       "head -1; }}",
                                       NUTIK_TEST_PROGRAM),
                                scratch_.folder());
  EXPECT_NE(result.out, "");
  EXPECT_EQ(read_file(scratch_ / "status"), std::to_string(128 + SIGPIPE) + "\n");
  EXPECT_TRUE(files_with(scratch_.folder(), "out.").empty());
}

// `ulimit -t` ends the process, which leaves nothing else.
TEST_F(Limits, OfTimeLeaveNoTemporaryFile) {
  RunningProgram running({"video", "--renderer", "reference", "--out-fps", "1000", "--speed", "0.01", "--raw",
                          "64x64:gray", "-f", "64", "clip.raw", "out.mkv"},
                         scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }));
  EXPECT_EQ(running.end_with(SIGXCPU), -SIGXCPU);
  EXPECT_TRUE(files_with(scratch_.folder(), "out.").empty());
  // Also where a driver's compiler has put handlers in their places, and both limits of the shell are one.
  const auto late = run_below("ulimit -t 2;", format("video --out-fps 1000 --speed 0.001 {} out.mkv", kClip));
  EXPECT_EQ(late.status, 128 + SIGXCPU) << late.err;
  EXPECT_TRUE(files_with(scratch_.folder(), "out.").empty());
}

// What is opened next would get the stream's number, and what is printed.
TEST_F(Limits, OfStandardStreamsKeepWordsOutOfFiles) {
  std::string list;
  for (int i = 0; i < 20; ++i) list += format("--start {0}f --exposure 1f {0}.pgm\n--nonsense {0}\n", i);
  scratch_.write("list.txt", list);
  ASSERT_EQ(run_below("", format("encode {} c.tik", kClip)).status, 0);
  EXPECT_EQ(run_below("", "batch -q list.txt c.tik").status, 1);
  std::vector<std::string> pictures;
  for (int i = 0; i < 20; ++i) pictures.push_back(read_file(scratch_ / format("{}.pgm", i)));
  EXPECT_EQ(run_below("", "batch -q --overwrite list.txt c.tik <&- >&- 2>&-").status, 1);
  for (std::size_t i = 0; i < pictures.size(); ++i) EXPECT_EQ(read_file(scratch_ / format("{}.pgm", i)), pictures[i]);
  EXPECT_EQ(run_below("", "info c.tik >&-").status, 5);
}

TEST_F(Limits, OfMemoryAreNoDamage) {
  scratch_.write("large.tik", "");
  fs::resize_file(scratch_ / "large.tik", std::uintmax_t{1} << 36);
  const auto result = run_below("ulimit -v 20000000;", "info large.tik");
  EXPECT_EQ(result.status, 6) << result.err;
}

}  // namespace
}  // namespace nutik::test
